"""The equations of the method, with pictures that matplotlib has set as SVG.

MathML would need no pictures, but browsers set it badly where no mathematical font is installed.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from functools import cache
from importlib.resources import files

from gripscale.report.elements import Equation, Section, Text

_LW = "Lind & Wangenheim 2014, ASME IMECE2014-37998"

# name, LaTeX, words, source
EQUATIONS = [
    (
        "correlation",
        r"C_z(l) = \langle ( z(x+l) - z(x) )^2 \rangle",
        "Height difference correlation of the measured profile, over all pairs of valid heights a "
        "lag l apart.",
        f"{_LW}, equation 5",
    ),
    (
        "sines",
        r"C_z(l) = \sum_i A_i^2 \left( 1 - \cos \dfrac{2 \pi l}{\lambda_i} \right) , \qquad "
        r"\lambda_{i+1} = \dfrac{\lambda_i}{s_\lambda} , \quad A_{i+1} = \dfrac{A_i}{s_A}",
        "Superposed sine waves of unrelated phase, fitted in log C_z with two magnification "
        "factors.",
        f"{_LW}, figure 4",
    ),
    (
        "prony",
        r"E^*(\omega) = E_\infty + \sum_j E_j \dfrac{i \omega \tau_j}{1 + i \omega \tau_j}",
        "Rubber: generalized Maxwell (Prony) series of the master curve.",
        "J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 3",
    ),
    (
        "network",
        r"\tau_j \dfrac{\mathrm{d} \mathbf{A}_j}{\mathrm{d} t} = \bar{\mathbf{C}}^{-1} - "
        r"\mathbf{A}_j , \qquad \mathbf{S}_{\mathrm{iso}} = J^{-2/3} \, \mathrm{DEV} \left[ "
        r"G_\infty \mathbf{I} + \sum_j G_j \mathbf{A}_j \right]",
        "At finite strain each Maxwell element is a temporary network beside the permanent one "
        "(written here for a neo-Hookean permanent network; the inputs name the one used), with "
        "G = E/3 and a constant bulk modulus. The choice among forms with the same small-strain "
        "limit is physics: at steep waves it moves friction by 15 to 20 %.",
        "J. Lubliner, Mech. Res. Commun. 12 (1985) 93",
    ),
    (
        "steady",
        r"\dfrac{\mathrm{d}}{\mathrm{d} t} = v \dfrac{\partial}{\partial X} , \qquad "
        r"\omega_k = \dfrac{2 \pi k v}{\lambda_i} , \qquad t_1 = \dfrac{\ell_0}{v} , \quad "
        r"t_i = \dfrac{a_{i-1}}{v}",
        "Steady sliding is one problem in the frame of the wave: the history is a periodic "
        "convolution along straight lines. The mean state relaxes only for the load time: the "
        "passage of the footprint ℓ₀, or of the contact length a of the wave above.",
        "method of this software",
    ),
    (
        "contact",
        r"g \geq 0 , \qquad p_n \geq 0 , \qquad g \, p_n = 0",
        "Frictionless unilateral contact of gap g and normal pressure with the rigid sine at the "
        "deformed position.",
        "P. Wriggers & J. Reinelt, Comput. Methods Appl. Mech. Engrg. 198 (2009) 1996",
    ),
    (
        "pressure",
        r"p_{i+1} = p_i \dfrac{\lambda_i}{a_i}",
        "The mean pressure in the contact of one wave is what the next one receives; a is the "
        "contact length on the mean plane.",
        f"{_LW}, equation 1",
    ),
    (
        "area",
        r"\dfrac{A_r}{A_0} = \prod_i \dfrac{a_i}{\lambda_i}",
        "Real over nominal contact area.",
        f"{_LW}, equation 2",
    ),
    (
        "friction",
        r"\mu = \sum_i \mu_i , \qquad \mu_i = \dfrac{1}{p_i \lambda_i} \int_0^{\lambda_i} t_x \, "
        r"\mathrm{d} x = \dfrac{W_i}{p_i \lambda_i^2}",
        "Friction: each wave's from the horizontal contact traction, and independently from the "
        "energy W lost in the rubber per wavelength slid (and unit width). Their mismatch is the "
        "discretisation's own error.",
        f"{_LW}, equation 3; balance of energy",
    ),
    (
        "half_space",
        r"u(q) = \dfrac{2}{|q| \, M(q_x v)} \, p(q) , \qquad M = \dfrac{E^*}{1 - \nu^2}",
        "Displacement of a viscoelastic half-space under each harmonic of the contact pressure, at "
        "small strain; rubber of finite thickness has the compliance of its layer.",
        "K. L. Johnson, Contact Mechanics (1985), section 13.2",
    ),
    (
        "rough_contact",
        r"p \geq 0 , \qquad g = u + u_0 - h \geq 0 , \qquad p \, g = 0 , \qquad "
        r"\langle p \rangle = p_0",
        "Frictionless contact with the heights h as measured, by a primal-dual active set.",
        "M. Hintermüller, K. Ito & K. Kunisch, SIAM J. Optim. 13 (2002) 865",
    ),
    (
        "rough_friction",
        r"\mu = \dfrac{1}{p_0} \left\langle p \, \dfrac{\partial h}{\partial x} \right\rangle",
        "Friction of the hysteresis, and independently from the energy lost in every harmonic.",
        "balance of energy",
    ),
    (
        "surface",
        r"A_{\mathrm{surface}} = \mathrm{erf} \left( f^{\, 1 - A/2} \, \mathrm{erf}^{-1} A "
        r"\right) , \qquad \ln \dfrac{\mu_{\mathrm{surface}}}{\mu} = (1 - A^4) \ln g "
        r"+ A^4 \ln 1.11",
        "From the area A and the friction of measured lines to the isotropic surface they lie on; "
        "f and g follow from how far the heights of a line reach up and how few carry. A map "
        "needs no such step.",
        "synthetic surfaces of eight families, method of this software",
    ),
    (
        "interface",
        r"\mu_{\mathrm{adh}} = \tau_f(v, T) \, \dfrac{A_r}{A_0 \, p_0}",
        "Area term: the real contact area sheared at the stress of the interface.",
        "B. Lorenz et al., J. Chem. Phys. 142 (2015) 194701",
    ),
]


@cache
def method_equations() -> list[Equation]:
    """Return every equation that a model may name, with pictures in base64."""
    equations = []
    for name, latex, words, source in EQUATIONS:
        svg = picture(name)
        sizes = re.search(r'<svg[^>]* width="([\d.]+)pt" height="([\d.]+)pt"', svg)
        assert sizes is not None
        width, height = (round(float(points) * 4.0 / 3.0) for points in sizes.groups())
        data = base64.b64encode(svg.encode("utf-8")).decode("ascii")
        equations.append(Equation(name, latex, data, width, height, words, source))
    return equations


def picture(name: str) -> str:
    """Return the picture of an equation, SVG."""
    stored = files("gripscale.report").joinpath("templates", "equations", f"{name}.svg")
    return stored.read_text(encoding="utf-8")


def method_section(*methods: Sequence[str]) -> Section:
    """Return what the models that were run say of themselves (`gripscale.model.Model.method`).

    Each method is texts and names of equations; nothing else is shown.
    """
    by_name = {equation.name: equation for equation in method_equations()}
    items = dict.fromkeys(item for method in methods for item in method)
    return Section("method", "Method", [by_name.get(item) or Text(item) for item in items])
