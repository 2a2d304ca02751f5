"""Argument checks shared by every package: one clear sentence for each way a value can be wrong."""

from __future__ import annotations

import difflib
import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, is_dataclass
from functools import partial
from typing import Any, ClassVar, TypeVar, dataclass_transform

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core.arrays import LEAST as LEAST
from gripscale.core.arrays import MOST as MOST
from gripscale.core.arrays import Array, Mask
from gripscale.core.described import Described
from gripscale.core.errors import InputError
from gripscale.core.units import si_value
from gripscale.core.wording import short_repr as short_repr
from gripscale.core.wording import shortened as shortened

_T = TypeVar("_T")


def number(name: str, value: Any, *, unit: str = "", infinite: bool = False) -> float:
    """Return `value` as a float, zero or from `LEAST` to `MOST` in size; else raise `InputError`.

    With a unit, a text such as "3 bar" is a number of that unit. NaN is refused, infinity is
    accepted only with `infinite`.
    """
    expected = f"{name} must be a finite number{_in(unit)}"
    value = si_value(name, value, unit, strict=False)
    numeric = isinstance(value, int | float) or hasattr(value, "dtype")
    if not numeric or not _may_be_real(value) or np.ndim(value) > 0:
        raise InputError(f"{expected}; got {short_repr(value)}")
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError) as error:  # an int may be beyond any float
        raise InputError(f"{expected}; got {short_repr(value)}") from error
    if math.isnan(result) or (math.isinf(result) and not infinite):
        raise InputError(f"{expected}; got {result}")
    if abs(result) > MOST and math.isfinite(result):
        raise InputError(f"{expected} of at most {MOST:g}; got {result:g}")
    if 0.0 < abs(result) < LEAST:
        raise InputError(f"{expected} of at least {LEAST:g} in size; got {result:g}")
    return result


def positive(name: str, value: Any, *, unit: str = "", infinite: bool = False) -> float:
    """Return `value` as a float; raise `InputError` unless it is above zero."""
    result = number(name, value, unit=unit, infinite=infinite)
    if result <= 0.0:
        raise InputError(f"{name} must be greater than zero{_in(unit)}; got {result:g}")
    return result


def not_negative(name: str, value: Any, *, unit: str = "", infinite: bool = False) -> float:
    """Return `value` as a float; raise `InputError` if it is below zero."""
    result = number(name, value, unit=unit, infinite=infinite)
    if result < 0.0:
        raise InputError(f"{name} must not be negative{_in(unit)}; got {result:g}")
    return result


def at_most_one(name: str, value: float) -> float:
    """Return a checked `value`; raise `InputError` if it is above one."""
    if value > 1.0:
        raise InputError(f"{name} must be at most 1; got {value:g}")
    return value


def complex_number(name: str, value: Any, *, unit: str = "") -> complex:
    """Return a real or complex `value` as a complex number with parts of at most `MOST`."""
    if not np.iscomplexobj(value):
        return complex(number(name, value, unit=unit))
    parts = np.real(value), np.imag(value)
    return complex(*(number(name, part, unit=unit) for part in parts))


def whole(name: str, value: Any, *, least: int, most: int) -> int:
    """Return `value` as an int; raise `InputError` unless it is a whole number in the limits."""
    result = int(value) if _is_whole_number(value) else number(name, value)
    if result != math.floor(result) or not least <= result <= most:
        raise InputError(
            f"{name} must be a whole number from {least} to {most}; got {short_repr(value)}"
        )
    return int(result)


def counted(name: str, value: Any, most: int) -> int:
    """Return the index, from 0, of a number counted from 1 to `most`; else `InputError`."""
    if _is_whole_number(value) and value == 0:
        raise InputError(f"{name} is counted from 1, up to {most}; got 0")
    return whole(name, value, least=1, most=most) - 1


def vector(name: str, value: ArrayLike, *, unit: str = "", missing: bool = False) -> Array:
    """Return `value` as a 1-D float array of entries of at most `MOST`.

    NaN passes only with `missing`; masked entries become NaN.
    """
    expected = f"{name} must be a list of finite numbers{' or NaN' * missing}{_in(unit)}"
    result = array(si_value(name, value, unit, strict=False), expected)
    if result.ndim != 1:
        raise InputError(f"{expected} with one dimension; got {result.ndim} dimensions")
    refuse_entries(result, np.isinf(result) if missing else ~np.isfinite(result), expected)
    expected = f"{name} must be numbers of at most {MOST:g}{_in(unit)}"
    refuse_entries(result, np.abs(result) > MOST, expected)
    return result


def array(value: ArrayLike, expected: str) -> Array:
    """Return a copy of `value` as a float array, NaN where it is masked.

    Raises `InputError`, which begins with what was `expected`, if an entry is not a real number.
    Texts that spell numbers and complex numbers without imaginary part are refused.
    """
    try:
        entries = np.asarray(value)
        if not _may_be_real(entries):
            raise InputError(f"{expected}; got {short_repr(value)}")
        result = np.array(entries, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(f"{expected}; got {short_repr(value)}") from error
    if isinstance(value, np.ma.MaskedArray):
        result[np.ma.getmaskarray(value)] = np.nan
    return result


def positive_vector(name: str, value: ArrayLike, *, unit: str = "") -> Array:
    """Return `value` as a 1-D float array; raise `InputError` unless from `LEAST` to `MOST`."""
    result = vector(name, value, unit=unit)
    refuse_entries(result, result <= 0.0, f"{name} must be greater than zero{_in(unit)}")
    refuse_entries(result, result < LEAST, f"{name} must be at least {LEAST:g}{_in(unit)}")
    return result


def not_negative_vector(name: str, value: ArrayLike, *, unit: str = "") -> Array:
    """Return `value` as a 1-D float array; raise `InputError` if an entry is below zero."""
    result = vector(name, value, unit=unit)
    refuse_entries(result, result < 0.0, f"{name} must not be negative", f" {unit}")
    return result


def increasing_vector(name: str, value: ArrayLike, *, unit: str = "") -> Array:
    """Return `value` as a 1-D float array; raise `InputError` unless it increases from above 0."""
    result = positive_vector(name, value, unit=unit)
    falls = np.diff(result, prepend=0.0) <= 0.0
    refuse_entries(result, falls, f"{name} must increase", f" {unit}")
    return result


def refuse_entries(values: Array, bad: Mask, expected: str, unit: str = "") -> None:
    """Raise `InputError`, with what was `expected`, for the first of `values` that is `bad`."""
    if bad.any():
        at = int(np.argmax(bad))
        raise InputError(f"{expected}; got {values[at]:g}{unit} at index {at}")


def fraction(name: str, value: Any) -> float:
    """Return `value` as a float; raise `InputError` unless it is above zero and at most one."""
    return at_most_one(name, positive(name, value))


def share(name: str, value: Any) -> float:
    """Return `value` as a float; raise `InputError` unless it is from zero to one."""
    return at_most_one(name, not_negative(name, value))


def interval(name: str, value: ArrayLike, *, unit: str = "") -> tuple[float, float]:
    """Return `value` as two rising numbers above zero; raise `InputError` if it is none."""
    ends = positive_vector(name, value, unit=unit)
    if len(ends) != 2 or ends[0] >= ends[1]:
        raise InputError(
            f"{name}{_in(unit)} must be a lower and a higher value; got {short_repr(value)}"
        )
    return float(ends[0]), float(ends[1])


def same_length(least: int, **vectors: Array) -> None:
    """Raise `InputError` unless the named arrays have the same length, `least` or more."""
    sizes = [values.size for values in vectors.values()]
    if min(sizes) < least or len(set(sizes)) > 1:
        raise InputError(
            f"{enumerated(vectors)} must have the same length{f', at least {least}' * (least > 0)}"
            f"; got {enumerated(sizes)}"
        )


def enumerated(items: Iterable[Any]) -> str:
    """Return items as a sentence lists them: a, b and c."""
    *others, last = map(str, items)
    return f"{', '.join(others)} and {last}" if others else last


def flag(name: str, value: Any) -> bool:
    """Return `value`; raise `InputError` unless it is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise InputError(f"{name} must be True or False; got {short_repr(value)}")
    return bool(value)


def instance(name: str, value: Any, kind: type[_T]) -> _T:
    """Return `value`; raise `InputError` unless it is an instance of `kind`."""
    if not isinstance(value, kind):
        article = "an" if kind.__name__[0] in "AEIOU" else "a"
        raise InputError(f"{name} must be {article} {kind.__name__}; got {type(value).__name__}")
    return value


def instances(name: str, values: Any, kind: type[_T]) -> list[_T]:
    """Return `values` as a list; raise `InputError` unless it holds instances of `kind` only."""
    if not isinstance(values, Sequence) or isinstance(values, str | bytes) or not values:
        raise InputError(
            f"{name} must be a list of at least one {kind.__name__}; got {short_repr(values)}"
        )
    return [instance(f"each of {name}", value, kind) for value in values]


def real(name: str, value: ArrayLike, *, unit: str = "") -> Array:
    """Return `value`, of any shape, as a float array of entries of at most `MOST`."""
    expected = f"{name} must be finite numbers of at most {MOST:g}{_in(unit)}"
    result = array(si_value(name, value, unit, strict=False), expected)
    bad = ~(np.abs(result) <= MOST)
    if bad.any():
        raise InputError(f"{expected}; got {result[bad][0]:g}")
    return result


def text(name: str, value: Any) -> str:
    """Return `value`; raise `InputError` unless it is a text."""
    if not isinstance(value, str):
        raise InputError(f"{name} must be a text; got {short_repr(value)}")
    return value


def one_of(name: str, value: Any, choices: Iterable[str]) -> str:
    """Return `value`; raise `InputError` unless it is among the `choices`."""
    names = list(choices)
    if not isinstance(value, str) or value not in names:
        raise InputError(f"{name} must be one of {', '.join(names)}; got {short_repr(value)}")
    return str(value)


def allowed_names(kind: str, names: Iterable[str], allowed: Iterable[str]) -> None:
    """Raise `InputError`, with the nearest allowed name, unless all `names` are `allowed`."""
    choices = list(allowed)
    for name in names:
        if name not in choices:
            raise InputError(f"unknown {kind} {name}; {instead_of(name, choices)}")


def instead_of(name: str, choices: Sequence[str], most: int | None = None) -> str:
    """Return in words the choice nearest to an unknown name, or `most` of the choices."""
    if near := difflib.get_close_matches(name, choices, n=1):
        return f"did you mean {near[0]}?"
    rest = ", ..." if most and len(choices) > most else ""
    return f"expected one of {', '.join(choices[:most])}{rest}"


def _may_be_real(value: Any) -> bool:
    """Return whether type or dtype exclude a truth, text, complex number, date and mask."""
    if value is np.ma.masked or isinstance(value, bool | str | bytes | complex):
        return False
    return getattr(getattr(value, "dtype", None), "kind", "f") in "iufO"


def _is_whole_number(value: Any) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def _in(unit: str) -> str:
    return f" [{unit}]" if unit else ""


def from_mapping(law: type[_T], kind: str, values: Mapping[str, Any]) -> _T:
    """Return the dataclass `law` with parameters `values`; those with a default may be left out."""
    parameters = [item for item in fields(law) if item.init]  # type: ignore[arg-type]
    names = [item.name for item in parameters]
    needed = [p.name for p in parameters if p.default is p.default_factory is MISSING]
    if set(values) - set(names) or set(needed) - set(values):
        raise InputError(
            f"{kind} takes {', '.join(names) or 'no parameters'}"
            f", of which {', '.join(needed) or 'none'} must be given; got "
            f"{', '.join(map(str, values)) or 'none'}"
        )
    return law(**values)


def of_kind(laws: Mapping[str, type[_T]], name: str, values: Any) -> _T:
    """Return the law of a mapping such as {"kind": "wlf", "c1": 8.0, "c2": 120.0}."""
    if not isinstance(values, Mapping):
        raise InputError(f"{name} must be a mapping with its kind; got {short_repr(values)}")
    parameters = dict(values)
    kind = one_of("kind", parameters.pop("kind", None), laws)
    return from_mapping(laws[kind], kind, parameters)


def checked(
    check: Callable[..., Any],
    *,
    default: Any = MISSING,
    repr: bool = True,
    quantity: str = "",
    **options: Any,
) -> Any:
    """Declare a field of a `Checked` class: it holds ``check(name, value, **options)``.

    A value of None passes unchecked where None is the default. `quantity` is the kind of quantity
    a case file states the field in, where its unit does not say so.
    """
    metadata = {"check": partial(check, **options), "quantity": quantity}
    return field(default=default, repr=repr, metadata=metadata)


@dataclass_transform(frozen_default=True, field_specifiers=(checked, field))
class Checked(Described):
    """Base of frozen dataclasses whose fields declare their checks once, with `checked`.

        class Sphere(Checked):
            radius: float = checked(positive, unit="m")

    A subclass is a frozen dataclass; keywords such as ``eq=False`` go to `dataclasses.dataclass`.
    One that holds arrays needs ``eq=False`` to be compared by its content. Checked arrays are
    read-only copies. A subclass with conditions between fields, or with fields that follow from
    others, extends `__post_init__`, calls that of this class first and sets such fields with
    `_set`.
    """

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__()
        # A subclass without fields of its own keeps the constructor that it inherits.
        if options or not is_dataclass(cls) or inspect.get_annotations(cls):
            dataclass(frozen=True, repr=False, **options)(cls)

    def __post_init__(self) -> None:
        for item in fields(self):
            value, check = getattr(self, item.name), item.metadata.get("check")
            if check is not None and not (value is None and item.default is None):
                if kind := item.metadata.get("quantity"):
                    value = si_value(item.name, value, "", kind, strict=False)
                self._set(**{item.name: check(item.name, value)})

    def _set(self, **values: Any) -> None:
        """Store values of fields, arrays read-only, while the instance is made."""
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
            object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        """Compare all fields, arrays to the last bit."""
        return type(other) is type(self) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def _content(self) -> tuple[Any, ...]:
        values = (getattr(self, item.name) for item in fields(self) if item.compare)
        return tuple(v.tobytes() if isinstance(v, np.ndarray) else v for v in values)
