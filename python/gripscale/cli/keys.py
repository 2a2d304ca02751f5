"""Keys of a case as options of commands, and the value that a case has for what is typed."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Annotated, Any, get_args

from gripscale.questions import terminal


def _key(text: str, kind: Any = str, *names: str, metavar: str | None = None) -> Any:
    value_type = kind if kind is bool else kind | None
    return Annotated[value_type, terminal.option(text, *names, metavar=metavar)]


KEY_OPTIONS: dict[str, Any] = {
    # of [surface]
    "scales": _key("Number of sine waves.", int),
    "smallest_wavelength": _key('The last wave, such as "0.1 mm".'),
    "cut_off": _key(
        'Where the roughness ends, in its place: "0.1 mm", "instrument", "rms_slope 1.3" (of the '
        'surface), "rms_slope 1.3 of profile", either with "extrapolate" at its end.'
    ),
    "top_height_fraction": _key("Part of the heights, from the top; 1 by default.", float),
    "s_wavelength": _key("Given instead of fitted.", float),
    "s_amplitude": _key("Given instead of fitted.", float),
    "single_factor": _key("One factor for both lengths.", bool),
    "crop": terminal.SurfaceCrop,
    "x_unit": terminal.SurfaceUnit,
    "z_unit": terminal.SurfaceUnit,
    "z_axis": terminal.SurfaceAxis,
    "channel": terminal.SurfaceChannel,
    "step": _key('Distance between points where a file has none: "0.1 mm", of a map "1 um, 2 um".'),
    "spikes": _key("Rule for spikes: isolated, by default, iso13473 or none."),
    "detrend": _key("linear, by default, mean or none."),
    "longest_wavelength": terminal.LongestWavelength,
    # of [rubber]
    "terms": _key("Relaxation times; chosen if not given.", int),
    "bulk_modulus": _key('Such as "2 GPa".'),
    "modulus": _key("E (Young) or G (shear), if the file of the rubber does not say."),
    "frequency": _key('Of all rows, such as "10 Hz", if no column holds it: a temperature ramp.'),
    "frequency_unit": _key("Such as rad/s, if the file of the rubber does not state it."),
    "modulus_unit": _key("Such as MPa, if that file does not state it, or states a wrong one."),
    "temperature_unit": _key("K, C or F, if the file of the rubber does not state it."),
    "reference_temperature": _key(
        'Such as "20 C": what a master curve holds for, or sweeps are shifted to.'
    ),
    "columns": _key(terminal.COLUMNS),
    "sheet": _key("Excel sheet of the rubber, by name or number from 1, if several hold moduli."),
    "header": _key("Lines above the rows of the rubber, if there are numbers among them.", int),
    "outlier_threshold": _key(
        "Times the typical scatter beyond which a row is left out; inf keeps all.", float
    ),
    "shift": _key("Table of shift factors to be taken; sweeps."),
    "wlf": _key(
        'Constants c1 and c2 of a shift, such as 8.86 "101.6 K".',
        tuple[float, str],
        metavar="C1 C2",
    ),
    "vertical": _key("Find vertical shifts as well; sweeps.", bool, "--vertical"),
    "thickness": _key('Of the rubber, such as "8 mm"; it has no end by default.'),
    # of [load] and [conditions]
    "pressure": _key('Such as "3 bar", as by default.'),
    "speed": _key('Such as "1 m/s", as by default.'),
    "footprint": _key('Length of the nominal contact; "100 mm" by default.'),
    "temperature": _key('Of the rubber before the contact, such as "20 C".'),
    "interface": _key('"dry": a dry road, which also shears the contact area.'),
    # of [conditions.softening]
    "amplitude": _key("single or peak-to-peak, if strain sweeps do not say."),
    "deformation": _key("tension or shear, if strain sweeps do not say."),
    "measured_at": _key('Strain of the master curve, beside strain sweeps; "0.1 %" by default.'),
    "strain_unit": _key("1 or %, if not stated."),
}
# What a case has for what is typed, where that is another.
_READ: dict[str, Callable[[Any], Any]] = {
    "crop": list,
    "channel": terminal.column_of,
    "step": terminal.lengths_of,
    "columns": terminal.columns_of,
    "sheet": terminal.column_of,
    "wlf": lambda constants: {"kind": "wlf", "c1": constants[0], "c2": constants[1]},
}


def takes_keys(*names: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command options for keys of a case; its argument `keys` has those that are stated."""

    def with_options(body: Callable[..., None]) -> Callable[..., None]:
        @wraps(body)
        def inside(**options: Any) -> None:
            typed = {name: options.pop(name) for name in names}
            values = {n: v for n, v in typed.items() if v is not None and v is not False}
            body(keys={n: _READ[n](v) if n in _READ else v for n, v in values.items()}, **options)

        signature = inspect.signature(body, eval_str=True)
        parameters = [item for item in signature.parameters.values() if item.name != "keys"]
        for name in names:
            kind, added = KEY_OPTIONS[name], inspect.Parameter.KEYWORD_ONLY
            default = False if get_args(kind)[0] is bool else None
            parameters.append(inspect.Parameter(name, added, default=default, annotation=kind))
        inside.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
        inside.__annotations__ = {item.name: item.annotation for item in parameters}
        return inside

    return with_options
