"""What every table of a case file is, and tables that a `kind` tells apart."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from types import MappingProxyType, UnionType
from typing import (
    Annotated,
    Any,
    ClassVar,
    Literal,
    NamedTuple,
    Union,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, ValidationError, create_model
from pydantic import Field as PydanticField
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, core_schema

from gripscale.core import checks
from gripscale.core.checks import short_repr
from gripscale.core.units import UNITS, listed, parse_quantity, size_of_count, spelled, such_as
from gripscale.rubber.columns import FileLayout

# Plain types in words, and in JSON Schema.
PLAIN: dict[Any, tuple[str, str]] = {
    bool: ("true or false", "boolean"),
    int: ("a whole number", "integer"),
    float: ("a number", "number"),
    str: ("a text", "string"),
}
# What pydantic calls a limit, and what it is called here and in JSON Schema.
LIMITS = {
    "ge": ("at least {:g}", "minimum"),
    "gt": ("above {:g}", "exclusiveMinimum"),
    "le": ("at most {:g}", "maximum"),
    "lt": ("below {:g}", "exclusiveMaximum"),
    "multiple_of": ("a multiple of {:g}", "multipleOf"),
}


@dataclass(frozen=True)
class Reading:
    """Beside a type: reads a value as a person writes it, before pydantic looks at its type."""

    words: str
    """What is expected."""
    read: Callable[[Any], Any]
    """Returns what the type asks for; raises `ValueError` with one sentence."""
    laws: Mapping[str, type] = field(default_factory=dict, hash=False)
    """The laws whose tables it reads, by kind."""
    quantity: str = ""
    """Kind of the quantity that it reads, such as length; empty for anything else."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Read the value before pydantic looks at it."""
        return core_schema.no_info_before_validator_function(self.read, handler(source))


class KeyQuantity(NamedTuple):
    """A quantity with a unit that a key takes."""

    kind: str
    pair: bool
    """Whether it takes a list of two, such as both ends of a range."""


def quantity_of(field: FieldInfo) -> KeyQuantity | None:
    """Return the quantity that a key takes, or None of a key that takes anything else."""
    annotation, marks = type_and_marks(field.annotation, field.metadata)
    pair = get_origin(annotation) is list
    if pair:
        if not any(getattr(mark, "max_length", None) == 2 for mark in marks):
            return None
        _, marks = type_and_marks(get_args(annotation)[0])
    kind = next((mark.quantity for mark in marks if isinstance(mark, Reading)), "")
    return KeyQuantity(kind, pair) if kind else None


def type_and_marks(annotation: Any, metadata: Iterable[Any] = ()) -> tuple[Any, list[Any]]:
    """Return a type without None and `Annotated` around it, and the marks of both."""
    marks = list(metadata)
    if get_origin(annotation) is Annotated:
        inner, *more = get_args(annotation)
        inside = [part for mark in more if isinstance(mark, FieldInfo) for part in mark.metadata]
        return type_and_marks(inner, [*more, *inside, *marks])
    parts = [part for part in get_args(annotation) if part is not type(None)]
    optional = len(parts) == 1 and get_origin(annotation) in (Union, UnionType)
    return type_and_marks(parts[0], marks) if optional else (annotation, marks)


def expected(annotation: Any, metadata: Iterable[Any] = ()) -> str:
    """Return what a value of a type must be, such as "a whole number, at least 1"."""
    annotation, marks = type_and_marks(annotation, metadata)
    for mark in marks:
        if isinstance(mark, Reading):
            return mark.words
    limits = [
        words.format(value)
        for mark in marks
        for name, (words, _) in LIMITS.items()
        if (value := getattr(mark, name, None)) is not None
    ]
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        words = " or ".join(json.dumps(part) for part in parts)
    elif origin is list:
        least = max((getattr(mark, "min_length", 1) for mark in marks), default=1)
        words = f"a list{f' of {least}' * (least > 1)}, each {expected(parts[0])}"
    elif parts:
        words = " or ".join(expected(part) for part in parts if part is not type(None))
    elif isinstance(annotation, type) and issubclass(annotation, BaseModel):
        words = f"a table with {', '.join(annotation.model_fields)}"
    else:
        words = PLAIN.get(annotation, ("a value",))[0]
    return ", ".join([words, *limits])


# What is said of a value that pydantic refused with an error of this type.
_REFUSALS = {
    "bool_type": "expected true or false",
    "finite_number": "expected a finite number",
    "float_type": "expected a number",
    "greater_than": "expected greater than {gt:g}",
    "greater_than_equal": "expected at least {ge:g}",
    "int_parsing_size": "expected a whole number of fewer digits",
    "int_type": "expected a whole number",
    "less_than": "expected less than {lt:g}",
    "less_than_equal": "expected at most {le:g}",
    "list_type": "expected a list",
    "literal_error": "expected {expected}",
    "model_type": "expected a table",
    "multiple_of": "expected a multiple of {multiple_of:g}",
    "string_type": "expected a string",
    "too_long": "expected at most {max_length} items",
    "too_short": "expected at least {min_length} items",
    "value_error": "{error}",
}


def sentence(error: ValidationError, model: type[BaseModel], *, in_table: bool = False) -> str:
    """Return the first complaint as one sentence; an unknown key goes before its consequences.

    `in_table`: the model is a whole file, whose first names are those of tables.
    """
    first = first_complaint(error)
    owner, key = model, str(first["loc"][-1]) if first["loc"] else ""
    for part in first["loc"][:-1]:
        if isinstance(part, str):
            owner = _model_in(owner.model_fields[part].annotation) or owner
    where = _location(first["loc"], in_table=in_table)
    kind, value = first["type"], first["input"]
    if kind == "extra_forbidden":
        names = list(owner.model_fields)
        if instead := getattr(owner, "gone", {}).get(key):
            return f"unknown key {where}; it is gone: {instead}"
        near = difflib.get_close_matches(key, names, n=1)
        hint = f"did you mean {near[0]}?" if near else f"expected one of {', '.join(names)}"
        return f"unknown key {where}; {hint}"
    if kind == "missing":
        field = owner.model_fields[key]
        return f"{where} is missing; expected {expected(field.annotation, field.metadata)}"
    words = _REFUSALS[kind].format(**first.get("ctx", {}))
    reason = words.removesuffix("s") if words.endswith(" 1 items") else words
    if isinstance(value, dict):
        return f"{where}: {reason}" if where else reason
    text = repr(value)
    return f"{where} = {text if len(text) <= 60 else f'{text[:57]}...'}: {reason}"


def first_complaint(error: ValidationError) -> ErrorDetails:
    """Return what is said of a table: an unknown key before the rest."""
    complaints = error.errors(include_url=False)
    unknown = [c for c in complaints if c["type"] == "extra_forbidden"]
    return (unknown or complaints)[0]


def _location(loc: tuple[int | str, ...], *, in_table: bool) -> str:
    """Return `[table] key[index]` or `[table.table] key` for pydantic's location."""
    if in_table and loc and all(isinstance(part, str) for part in loc):
        *tables, key = map(str, loc) if len(loc) > 1 else (*loc, "")
        return f"[{'.'.join(map(str, tables))}] {key}".strip()
    words = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in loc)
    words = words.removeprefix(".")
    if not (in_table and words):
        return words
    table, _, key = words.partition(".")
    return f"[{table}] {key}".strip()


def _model_in(annotation: Any) -> type[BaseModel] | None:
    """Return the model inside `annotation`, such as Wave in `list[Wave] | None`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((m for part in get_args(annotation) if (m := _model_in(part))), None)


class CaseTable(BaseModel):
    """One table of the case file: unknown keys are refused, values are not bent into shape.

    The text below a key is its meaning in the list of keys and in the documentation.
    """

    # the tables that a case names are checked when it is read, the others never
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, defer_build=True)
    # keys of earlier versions, and what to state instead
    gone: ClassVar[Mapping[str, str]] = MappingProxyType({})


def _positive(value: float) -> float:
    if value <= 0.0:
        raise ValueError("expected a value greater than zero")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise ValueError("expected zero or a positive value")
    return value


def _quantity(kind: str, check: Callable[[float], float] = float) -> Reading:
    """Return what reads a quantity with its unit, "3 bar", or a plain SI number, and checks it."""
    return Reading(
        f"a {kind} {such_as(kind)}", lambda value: check(parse_quantity(value, kind)), quantity=kind
    )


def unit_of_file(kind: str) -> Reading:
    """Return the type of a key that names the unit of a file."""
    words = f"one of {listed(kind)}"

    def read(value: Any) -> Any:
        if isinstance(value, str) and not (spelled(value, kind) or size_of_count(value, kind)):
            raise ValueError(f"expected {words}")
        return value

    return Reading(words, read)


Pressure = Annotated[float, _quantity("pressure", _positive)]
Length = Annotated[float, _quantity("length", _positive)]
Position = Annotated[float, _quantity("length")]
Duration = Annotated[float, _quantity("time", _positive)]
Speed = Annotated[float, _quantity("speed", _not_negative)]
Frequency = Annotated[float, _quantity("frequency", _positive)]
Temperature = Annotated[float, _quantity("temperature", _positive)]
TemperatureDifference = Annotated[float, _quantity("temperature difference", _positive)]
Strain = Annotated[float, _quantity("strain", _positive)]


# Which quantity has a unit: the first kind of it, temperature and not its difference for K.
_KIND_OF = {next(iter(units)): kind for kind, units in reversed(UNITS.items())}
_QUANTITIES = {
    checks.positive: _positive,
    checks.positive_vector: _positive,
    checks.interval: _positive,
    checks.not_negative: _not_negative,
}
# What checks of fields ask for, of quantities and of plain numbers.
_NUMBERS: dict[Any, dict[str, Any]] = {
    checks.positive: {"gt": 0.0},
    checks.not_negative: {"ge": 0.0},
    checks.fraction: {"gt": 0.0, "le": 1.0},
}


def table_of(law: Any) -> type[CaseTable]:
    """Return the table that states a law: a key for each field, read as its check says.

    The law is a `Checked` dataclass; the unit of a field says which quantity it is, and its check
    which values it takes. A law with a kind has a key for it. A table is returned as it is.
    """
    if issubclass(law, CaseTable):
        return cast(type[CaseTable], law)
    hints = get_type_hints(law)
    keys: dict[str, Any] = {"kind": (Literal[law.kind], ...)} if hasattr(law, "kind") else {}
    for item in fields(law):
        check, hint = item.metadata["check"], hints[item.name]
        rule = check.keywords.get("rule", check.func)
        parts = [part for part in get_args(hint) if part is not type(None)]
        optional = len(parts) < len(get_args(hint))
        value = parts[0] if optional else hint
        several = get_origin(value) in (tuple, Sequence)
        if value is float or several:
            kind = item.metadata["quantity"] or _KIND_OF.get(check.keywords.get("unit", ""))
            limits = {"allow_inf_nan": False} | _NUMBERS.get(rule, {})
            reading = _quantity(kind, _QUANTITIES.get(rule, float)) if kind else None
            number: Any = Annotated[float, reading or PydanticField(**limits)]
            most = 2 if get_origin(value) is tuple else None
            pair = PydanticField(min_length=2, max_length=most)
            value = Annotated[list[number], pair] if several else number
        elif isinstance(value, type) and issubclass(value, checks.Checked):
            value = Annotated[Any, stated_law(value)]
        default = ... if item.default is MISSING else item.default
        keys[item.name] = (value | None if optional else value, default)
    return create_model(law.__name__, __base__=CaseTable, **keys)


def law_from_table(law: type, value: Any) -> Any:
    """Return the law that a table states; a `ValueError` is one sentence."""
    table = table_of(law)
    try:
        read = table.model_validate(dict(value))
    except ValidationError as error:
        raise ValueError(sentence(error, table)) from error
    if table is law:
        return read
    return law(**{item.name: getattr(read, item.name) for item in fields(law)})


def law_keys(law: Any) -> dict[str, Any]:
    """Return the keys with which a case states a law, in SI units, exactly."""
    keys: dict[str, Any] = {"kind": law.kind} if hasattr(law, "kind") else {}
    for item in fields(law):
        value = getattr(law, item.name)
        if value is None:
            continue
        check = item.metadata["check"]
        kind = item.metadata["quantity"] or _KIND_OF.get(check.keywords.get("unit", ""))
        several = isinstance(value, Sequence) and not isinstance(value, str)
        if isinstance(value, checks.Checked):
            value = law_keys(value)
        elif kind == "temperature":
            value = [kelvin_text(each) for each in value] if several else kelvin_text(value)
        keys[item.name] = list(value) if several else value
    return keys


def kelvin_text(temperature: float) -> str:
    """Return a temperature [K] as a case states it: never without its unit."""
    return f"{float(temperature)!r} K"


_LONGEST_LIST = 49  # letters of the items of a list beyond which each has a line of its own


def toml_text(value: Any) -> str:
    """Return a text, a number, a truth value, a list or a table as TOML writes it in one key."""
    if isinstance(value, Mapping):
        pairs = ", ".join(f"{key} = {toml_text(item)}" for key, item in value.items())
        return f"{{ {pairs} }}"
    if isinstance(value, list):
        items = [toml_text(item) for item in value]
        if sum(len(str(item)) for item in value) > _LONGEST_LIST:
            return "\n".join(["[", *(f"  {item}," for item in items), "]"])
        return f"[{', '.join(items)}]"
    if isinstance(value, float) and not math.isfinite(value):
        return repr(float(value))  # inf and nan
    return json.dumps(value, ensure_ascii=False)


def stated_law(law: type, *, off: str = "") -> Reading:
    """Return what reads the table of `law`, such as { conductivity = "0.25 W/(m K)", ... }.

    The word `off` stands for none.
    """
    words = f"{_or_word(off)}a table with {', '.join(table_of(law).model_fields)}"

    def read(value: Any) -> Any:
        if isinstance(value, law) or (off and value == off):
            return value
        if not isinstance(value, Mapping):
            raise ValueError(f"expected {words}")
        return law_from_table(law, value)

    return Reading(words, read, {"": law})


def _or_word(word: str) -> str:
    return f'"{word}" or ' if word else ""


def by_kind(laws: Mapping[str, type], *, or_file: bool = False, off: str = "") -> Reading:
    """Return what reads the table of one of `laws` by its kind, or the name of a file.

    The word `off` stands for none.
    """
    kinds = ", ".join(laws)
    file = f"{_or_word(off)}{'the name of a file or ' * or_file}"
    words = f"{file}a table with kind (one of {kinds}) and its keys"

    def read(value: Any) -> Any:
        if isinstance(value, tuple(laws.values())) or (or_file and isinstance(value, str)):
            return value
        if off and value == off:
            return value
        if not isinstance(value, Mapping):
            raise ValueError(f"expected {words}")
        if "kind" not in value:
            raise ValueError(f"kind is missing; expected one of {kinds}")
        kind = value["kind"]
        if not isinstance(kind, str) or kind not in laws:
            raise ValueError(f"kind = {short_repr(kind)}: expected one of {kinds}")
        return law_from_table(laws[kind], value)

    return Reading(words, read, laws)


COLUMN = "its name or its number from 1"
_COLUMNS = (
    "three names or numbers from 1, of frequency, storage and loss modulus, or a table such as "
    "{ frequency = 1, storage = 2, loss_factor = 4 }"
)


def _column(value: Any) -> str | int:
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise ValueError(f"expected {COLUMN}")
    if isinstance(value, int) and value < 1:
        raise ValueError("columns, channels and sheets are counted from 1")
    return value


def _columns(value: Any) -> dict[str, str | int]:
    if not isinstance(value, dict | list):
        raise ValueError(f"expected {_COLUMNS}")
    return {name: _column(column) for name, column in FileLayout(columns=value).by_quantity.items()}


ColumnKey = Annotated[str | int, Reading(COLUMN, _column)]
Columns = Annotated[dict[str, str | int], Reading(_COLUMNS, _columns)]
