"""Materials of Abaqus, Ansys MAPDL and FEBio read back, after the manuals of those programs.

Only what the files of gripscale use is read; whatever else stands in one is an error. All three
become the same thing: a relaxed energy sum C_ij (I1 - 3)^i (I2 - 3)^j, a bulk modulus, and shear
moduli with relaxation times.
"""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as ET

import numpy as np

ABAQUS_ORDER = {
    "NEO HOOKE": [(1, 0)],
    "MOONEY-RIVLIN": [(1, 0), (0, 1)],
    "YEOH": [(1, 0), (2, 0), (3, 0)],
    "POLYNOMIAL": [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
}
ANSYS_ORDER = {
    ("NEO", 2): [(1, 0)],
    ("MOONEY", 2): [(1, 0), (0, 1)],
    ("YEOH", 3): [(1, 0), (2, 0), (3, 0)],
    ("POLY", 2): [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)],
}


@dataclass
class Material:
    """A material as a program understands it."""

    relaxed: dict[tuple[int, int], float]
    """C_ij of the relaxed rubber, in the unit of the file."""
    bulk: float
    moduli: np.ndarray
    """Shear moduli of the Maxwell elements."""
    times: np.ndarray
    wlf: tuple[float, float, float] | None = None
    """Reference temperature, c1, c2 of log10 a_T = -c1 (T - T0)/(c2 + T - T0)."""

    def complex_modulus(self, omega):
        """Return E* = 3 G* of small strains."""
        relaxed = 2.0 * (self.relaxed.get((1, 0), 0.0) + self.relaxed.get((0, 1), 0.0))
        phase = 1j * np.asarray(omega)[..., None] * self.times
        return 3.0 * (relaxed + (self.moduli * phase / (1.0 + phase)).sum(-1))

    def uniaxial_stress(self, s):
        """Return the nominal stress of the relaxed incompressible rubber at stretch s."""
        first, second = s**2 + 2.0 / s - 3.0, 2.0 * s + s**-2 - 3.0
        w1 = sum(
            c * i * first ** (i - 1) * second**j for (i, j), c in self.relaxed.items() if i > 0
        )
        w2 = sum(
            c * j * first**i * second ** (j - 1) for (i, j), c in self.relaxed.items() if j > 0
        )
        return 2.0 * (s - s**-2) * (w1 + w2 / s)


def read_abaqus(text: str) -> Material:
    """Return the material of an Abaqus file.

    Abaqus Keywords Reference Guide. *HYPERELASTIC: "MODULI: Set this parameter equal to
    INSTANTANEOUS ... to LONG TERM to indicate that the hyperelastic material constants define the
    long-term behavior"; data lines C10, D1 (NEO HOOKE), C10, C01, D1 (MOONEY-RIVLIN), C10, C20,
    C30, D1, D2, D3 (YEOH), and for POLYNOMIAL, N=2 C10, C01, C20, C11, C02, D1, D2. *VISCOELASTIC,
    TIME=PRONY: one line "g_i, k_i, tau_i" a term. *TRS: theta_0, C1, C2. A real number may have 20
    characters. Analysis User's Guide 22.7.1: C_ij(0) = C_ij(inf) / (1 - sum g_i), and
    -log10 A = C1 (theta - theta_0)/(C2 + theta - theta_0).
    """
    blocks: list[tuple[str, list[list[float]]]] = []
    for line in text.splitlines():
        assert len(line) <= 256
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            blocks.append((line, []))
        else:
            cells = [cell.strip() for cell in line.split(",")]
            assert len(cells) <= 8
            assert max(map(len, cells)) <= 20
            blocks[-1][1].append([float(cell) for cell in cells])
    found = {line.split(",")[0]: (line, rows) for line, rows in blocks}
    assert blocks[0][0].startswith("*MATERIAL, NAME=")
    assert len(found) == len(blocks)
    keyword, ((*constants,),) = found["*HYPERELASTIC"]
    form = keyword.split(",")[1].strip()
    order = ABAQUS_ORDER[form]
    assert ("N=2" in keyword) == (form == "POLYNOMIAL")
    stated, compliances = constants[: len(order)], constants[len(order) :]
    assert not any(compliances[1:])
    relaxed = dict(zip(order, stated, strict=True))
    bulk = 2.0 / compliances[0]
    if "*VISCOELASTIC" not in found:
        return Material(relaxed, bulk, np.zeros(0), np.ones(0))
    assert "MODULI=LONG TERM" in keyword
    assert "TIME=PRONY" in found["*VISCOELASTIC"][0]
    g, k, tau = np.array(found["*VISCOELASTIC"][1]).T
    assert not k.any()
    assert g.sum() < 1.0
    instantaneous = 2.0 * (relaxed[1, 0] + relaxed.get((0, 1), 0.0)) / (1.0 - g.sum())
    shift = None
    if "*TRS" in found:
        assert "DEFINITION=WLF" in found["*TRS"][0]
        shift = tuple(found["*TRS"][1][0])
    return Material(relaxed, bulk, instantaneous * g, tau, shift)


def read_ansys(text: str) -> Material:
    """Return the material of commands of Ansys MAPDL.

    Command Reference: "TB, Lab, MATID, NTEMP, NPTS, TBOPT" and "TBDATA, STLOC, C1, ..., C6: up to
    six constants per TBDATA command". Material Reference: "The elasticity constants correspond to
    the material behavior at the fast load limit"; TB,HYPER NEO has mu, d, MOONEY C10, C01, d, YEOH
    the C_i0 and then the d_k, POLY C10, C01, C20, C11, C02 and then the d_k; K = 2/d_1. TB,PRONY
    has alpha_1, tau_1, alpha_2, tau_2 ... with alpha_inf = 1 - sum alpha_i. TB,SHIFT,,,,WLF has
    T_r, C1, C2, log10 A = C1 (T - T_r)/(C2 + T - T_r), tau(T) = tau(T_r)/A.
    """
    tables: dict[str, tuple[list[str], dict[int, float]]] = {}
    current: dict[int, float] = {}
    for line in text.splitlines():
        if line.startswith("!"):
            continue
        assert len(line) <= 640
        cells = line.split(",")
        if cells[0] == "TB":
            current = {}
            tables[cells[1]] = (cells[2:], current)
            continue
        assert cells[0] == "TBDATA"
        assert len(cells) <= 8
        current |= {int(cells[1]) + i: float(cell) for i, cell in enumerate(cells[2:])}
    values = {
        name: [data[i] for i in range(1, len(data) + 1)] for name, (_, data) in tables.items()
    }
    _, _, count, option = tables["HYPER"][0]
    order = ANSYS_ORDER[option, int(count)]
    constants = values["HYPER"]
    fast = dict(zip(order, constants, strict=False))
    if option == "NEO":
        fast = {(1, 0): 0.5 * constants[0]}
    compliances = constants[len(order) :]
    assert not any(compliances[1:])
    alpha, tau = np.zeros(0), np.ones(0)
    if "PRONY" in tables:
        _, _, count, option = tables["PRONY"][0]
        assert option == "SHEAR"
        alpha, tau = np.array(values["PRONY"]).reshape(int(count), 2).T
    left = 1.0 - alpha.sum()
    instantaneous = 2.0 * (fast[1, 0] + fast.get((0, 1), 0.0))
    relaxed = {at: left * value for at, value in fast.items()}
    shift = None
    if "SHIFT" in tables:
        assert tables["SHIFT"][0][2:] == ["3", "WLF"]
        shift = tuple(values["SHIFT"])
    return Material(relaxed, 2.0 / compliances[0], instantaneous * alpha, tau, shift)


def read_febio(text: str) -> Material:
    """Return the material of an FEBio file.

    FEBio User Manual 4, "Uncoupled viscoelastic": g0 to g6 and t1 to t6 with the elastic material,
    G(t) = g0 + sum g_i exp(-t/t_i) times its deviatoric response; terms not given have g_i = 0, g0
    is 1 by default. "Uncoupled solid mixture": the deviatoric stresses of the solids add; k is
    that of the mixture, in older versions the sum of those of the solids. "Mooney-Rivlin":
    c1 (I1 - 3) + c2 (I2 - 3), c1 above zero; "Yeoh": sum c_i (I1 - 3)^i.
    """
    (material,) = ET.fromstring(text.encode()).iterfind("Material/material")
    solids = list(material.iterfind("solid")) if _kind(material).endswith("mixture") else [material]
    relaxed: dict[tuple[int, int], float] = {}
    moduli, times, bulk = [], [], 0.0
    for solid in solids:
        elastic, g0, terms = solid, 1.0, []
        if _kind(solid) == "uncoupled viscoelastic":
            (elastic,) = solid.iterfind("elastic")
            g0 = _number(solid, "g0", 1.0)
            names = [child.tag for child in solid if child.tag.startswith("g")]
            assert set(names) <= {f"g{i}" for i in range(7)}
            terms = [
                (_number(solid, f"g{i}", 0.0), _number(solid, f"t{i}", 1.0)) for i in range(1, 7)
            ]
        energy = _energy(elastic)
        bulk += _number(elastic, "k", 0.0)
        for at, value in energy.items():
            relaxed[at] = relaxed.get(at, 0.0) + g0 * value
        shear = 2.0 * (energy.get((1, 0), 0.0) + energy.get((0, 1), 0.0))
        moduli += [shear * g for g, _ in terms if g > 0.0]
        times += [t for g, t in terms if g > 0.0]
    assert material.find("k") is None or abs(_number(material, "k", 0.0) / bulk - 1.0) < 1e-14
    return Material(relaxed, bulk, np.array(moduli), np.array(times))


def _kind(element: ET.Element) -> str:
    return element.attrib["type"]


def _number(element: ET.Element, name: str, otherwise: float) -> float:
    found = element.find(name)
    return otherwise if found is None or found.text is None else float(found.text)


def _energy(element: ET.Element) -> dict[tuple[int, int], float]:
    if _kind(element) == "Yeoh":
        return {(i, 0): _number(element, f"c{i}", 0.0) for i in range(1, 4)}
    assert _kind(element) == "Mooney-Rivlin"
    assert _number(element, "c1", 0.0) > 0.0
    return {(1, 0): _number(element, "c1", 0.0), (0, 1): _number(element, "c2", 0.0)}


READERS = {"abaqus": read_abaqus, "ansys": read_ansys, "febio": read_febio}
