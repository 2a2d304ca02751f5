"""What every table of a case file is, and tables that a `kind` tells apart."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields
from functools import cache
from string import ascii_letters, digits
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal, cast, get_args, get_origin, get_type_hints

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError, create_model, with_config
from pydantic import Field as PydanticField
from pydantic.annotated_handlers import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import ErrorDetails, core_schema

from gripscale.core import checks
from gripscale.core.checks import short_repr
from gripscale.core.units import UNITS, listed, parse_quantity, size_of_count, spelled, such_as
from gripscale.rubber.columns import FileLayout

# Types of JSON Schema in words, and its limits of numbers.
_TYPES = {
    "boolean": "true or false",
    "integer": "a whole number",
    "number": "a number",
    "string": "a text",
}
_MOST_NAMES = 20  # keys that a sentence lists
_LIMITS = {
    "minimum": "at least {:g}",
    "exclusiveMinimum": "above {:g}",
    "maximum": "at most {:g}",
    "exclusiveMaximum": "below {:g}",
    "multipleOf": "a multiple of {:g}",
}


@dataclass(frozen=True)
class Reading:
    """Beside a type: reads a value as a person writes it, before pydantic looks at its type."""

    words: str  # what is expected
    read: Callable[[Any], Any]  # returns what the type asks for, or raises `ValueError`
    quantity: str = ""  # kind of the quantity that it reads, such as length; empty for others
    # Laws whose tables it reads, by kind, and JSON Schemas of texts in place of such a table.
    laws: Mapping[str, type] = field(default_factory=dict, hash=False)
    words_for_a_law: Sequence[Mapping[str, Any]] = field(default=(), hash=False)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Read the value before pydantic looks at its type."""
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, core: core_schema.CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Return what an editor allows: whatever may be read, with the words for a person."""
        words = {"expected": self.words, "quantity": self.quantity}
        if self.laws:
            options = [*self.words_for_a_law, *map(table_schema, self.laws.values())]
            return {**(options[0] if len(options) == 1 else {"anyOf": options}), **words}
        kind = handler(core).get("type")
        if kind == "number":
            kind = "string" if self.quantity == "temperature" else ["string", "number"]
        return words if kind in (None, "object") else {"type": kind, **words}


class _PlainSchema(GenerateJsonSchema):
    """JSON Schema of a table without null, which TOML does not have, and without titles."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> dict[str, Any]:
        """Return the schema of what may be left out."""
        return self.generate_inner(schema["schema"])

    def field_title_should_be_set(self, schema: Any) -> bool:
        """Return that keys have a name, and no title."""
        return False

    def encode_default(self, dft: Any) -> Any:
        """Return a default as a case states it."""
        return law_keys(dft) if isinstance(dft, checks.Checked) else super().encode_default(dft)


@cache
def table_schema(law: type) -> dict[str, Any]:
    """Return the JSON Schema of the table that states a law, with all tables in it.

    Beside the keywords of JSON Schema a table has what it is `about`, and the earlier keys that are
    `gone`; a key has what is `expected` in words and the kind of `quantity` it takes.
    """
    table = table_of(law)
    linked = table.model_json_schema(schema_generator=_PlainSchema)
    schema: dict[str, Any] = _inlined(linked, linked.get("$defs", {}))
    if table is not law:  # the class of the law explains its fields, not the table made of it
        options = ConfigDict(use_attribute_docstrings=True, arbitrary_types_allowed=True)
        explained = TypeAdapter(with_config(options)(law)).json_schema()
        for name, key in explained.get("properties", {}).items():
            schema["properties"][name]["description"] = key["description"]
    return schema


def _inlined(schema: Any, definitions: Mapping[str, Any]) -> Any:
    """Return a JSON Schema with its definitions where it refers to them."""
    if isinstance(schema, list):
        return [_inlined(part, definitions) for part in schema]
    if not isinstance(schema, dict):
        return schema
    if "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]] | schema
    parts = {key: part for key, part in schema.items() if key not in ("$defs", "$ref", "title")}
    return {key: _inlined(part, definitions) for key, part in parts.items()}


def choices_of(schema: Mapping[str, Any]) -> list[Any]:
    """Return the values that a JSON Schema lists; none where it does not."""
    return list(schema.get("enum", [schema["const"]] if "const" in schema else []))


def expected(schema: Mapping[str, Any]) -> str:
    """Return what a value with a JSON Schema must be, such as "a whole number, at least 1"."""
    if "expected" in schema:
        return str(schema["expected"])
    if "anyOf" in schema:
        return " or ".join(map(expected, schema["anyOf"]))
    if "properties" in schema:
        return f"a table with {', '.join(schema['properties'])}"
    if "items" in schema:
        least, most = (schema.get(name, 0) for name in ("minItems", "maxItems"))
        count = f" of {'at least ' * (least != most)}{least}" * (least > 0)
        return f"a list{count}, each {expected(schema['items'])}"
    words = " or ".join(map(json.dumps, choices_of(schema))) or _TYPES.get(
        schema.get("type", ""), "a value"
    )
    limits = [text.format(schema[name]) for name, text in _LIMITS.items() if name in schema]
    return ", ".join([words, *limits])


def sentence(error: ValidationError, model: type[BaseModel], *, in_table: bool = False) -> str:
    """Return the first complaint as one sentence; an unknown key goes before its consequences.

    `in_table`: the model is a whole file, whose first names are those of tables.
    """
    first = first_complaint(error)
    where, value = _location(first["loc"], in_table=in_table), first["input"]
    if first["type"] == "value_error":
        reason = str(first["ctx"]["error"])
    else:
        key, owner, schema = "", {}, table_schema(model)
        for part in first["loc"]:
            key, owner = str(part), schema
            inside = schema["items"] if isinstance(part, int) else schema["properties"]
            schema = inside if isinstance(part, int) else inside.get(part, {})
        if first["type"] == "extra_forbidden":
            instead = owner["gone"].get(key)
            cure = checks.instead_of(key, [*owner["properties"]], _MOST_NAMES)
            return f"unknown key {where}; {f'it is gone: {instead}' if instead else cure}"
        finite = first["type"] == "finite_number"
        reason = f"expected {'a finite number' if finite else expected(schema)}"
    if first["type"] == "missing":
        return f"{where} is missing; {reason}"
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
    names = next((at for at, part in enumerate(loc) if isinstance(part, int)), len(loc))
    depth = min(max(names - 1, 1), len(loc)) if in_table else 0
    table = f"[{'.'.join(map(str, loc[:depth]))}] " if depth else ""
    key = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in loc[depth:])
    return f"{table}{key.removeprefix('.')}".strip()


def _explain(schema: dict[str, Any], model: type[BaseModel]) -> None:
    """Say what a table is about, and list its keys before those it shares with others."""
    keys = schema["properties"]
    first = {name: keys[name] for name in keys if name in model.__annotations__}
    schema["properties"] = first | keys
    schema["about"] = (model.__doc__ or "").partition("\n")[0]
    schema["gone"] = dict(getattr(model, "gone", {}))


class CaseTable(BaseModel):
    """One table of the case file: unknown keys are refused, values are not bent into shape.

    The text below a key is its meaning in the list of keys and in the documentation.
    """

    # the tables that a case names are checked when it is read, the others never
    model_config = ConfigDict(
        extra="forbid",
        strict=True,
        frozen=True,
        defer_build=True,
        use_attribute_docstrings=True,
        json_schema_extra=_explain,
    )
    # keys of earlier versions, and what to state instead
    gone: ClassVar[Mapping[str, str]] = MappingProxyType({})


class _LawTable(CaseTable):
    """A table that is made of the class of a law, which has the text below each key."""

    model_config = ConfigDict(use_attribute_docstrings=False)


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


@cache
def table_of(law: Any) -> type[CaseTable]:
    """Return the table that states a law: a key for each field, read as its check says.

    The law is a `Checked` dataclass; the unit of a field says which quantity it is, and its check
    which values it takes. A law with a kind has a key for it. A table is returned as it is.
    """
    if issubclass(law, CaseTable):
        return cast(type[CaseTable], law)
    hints = get_type_hints(law)
    about = (law.__doc__ or "").partition("\n")[0]
    keys: dict[str, Any] = {}
    if hasattr(law, "kind"):
        keys["kind"] = (Literal[law.kind], PydanticField(description=about))
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
    return create_model(law.__name__, __base__=_LawTable, __doc__=about, **keys)


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


def case_value(value: Any, schema: Mapping[str, Any]) -> Any:
    """Return a value as a case states it in a key with this schema, in SI units, exactly."""
    if isinstance(value, checks.Checked):
        return law_keys(value)
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [case_value(item, schema.get("items", {})) for item in value]
    # a temperature [K] is never stated without its unit
    return f"{float(value)!r} K" if schema.get("quantity") == "temperature" else value


def law_keys(law: Any) -> dict[str, Any]:
    """Return the keys with which a case states a law, in SI units, exactly."""
    keys = table_schema(law.__class__)["properties"]
    kind = {"kind": law.kind} if hasattr(law, "kind") else {}
    values = {item.name: getattr(law, item.name) for item in fields(law)}
    return kind | {k: case_value(v, keys[k]) for k, v in values.items() if v is not None}


_BARE = frozenset(f"{ascii_letters}{digits}-_")  # letters of a key without quotation marks
_LONGEST_LIST = 49  # letters of the items of a list beyond which each has a line of its own


def toml_text(value: Any, longest: float = _LONGEST_LIST) -> str:
    """Return a text, a number, a truth value, a list or a table as TOML writes it in one key.

    The items of a list with more letters than `longest` have a line each.
    """
    if isinstance(value, Mapping):
        names = (key if key and _BARE.issuperset(key) else toml_text(key) for key in value)
        items = [toml_text(item, longest) for item in value.values()]
        return f"{{ {', '.join(f'{n} = {item}' for n, item in zip(names, items, strict=True))} }}"
    if isinstance(value, list):
        items = [toml_text(item, longest) for item in value]
        if sum(len(str(item)) for item in value) > longest:
            return "\n".join(["[", *(f"  {item}," for item in items), "]"])
        return f"[{', '.join(items)}]"
    if isinstance(value, float) and not math.isfinite(value):
        return repr(float(value))  # inf and nan
    return json.dumps(value, ensure_ascii=False)


def stated_law(laws: type | Mapping[str, type], *, or_file: bool = False, off: str = "") -> Reading:
    """Return what reads the table of a law, or of one of `laws` by its kind.

    The name of a file may stand for one, or the word `off` for none.
    """
    by_kind = laws if isinstance(laws, Mapping) else {"": laws}
    kinds = ", ".join(by_kind)
    keys = f"kind (one of {kinds}) and its keys"
    if not isinstance(laws, Mapping):
        keys = ", ".join(table_of(laws).model_fields)
    instead = [f'"{off}"'] * bool(off) + ["the name of a file"] * or_file
    words = " or ".join([*instead, f"a table with {keys}"])
    texts = [{"type": "string"}] * or_file + [{"enum": [off]}] * bool(off)

    def read(value: Any) -> Any:
        is_word = isinstance(value, str) and (or_file or (off and value == off))
        if value is None or is_word or isinstance(value, tuple(by_kind.values())):
            return value
        if not isinstance(value, Mapping):
            raise ValueError(f"expected {words}")
        if not isinstance(laws, Mapping):
            return law_from_table(laws, value)
        if "kind" not in value:
            raise ValueError(f"kind is missing; expected one of {kinds}")
        kind = value["kind"]
        if not isinstance(kind, str) or kind not in laws:
            raise ValueError(f"kind = {short_repr(kind)}: expected one of {kinds}")
        return law_from_table(laws[kind], value)

    return Reading(words, read, laws=by_kind, words_for_a_law=texts)


COLUMN = "its name or its number from 1"
_COLUMNS = (
    "three names or numbers from 1, of frequency, storage and loss modulus, or a table such as "
    "{ frequency = 1, storage = 2, loss_factor = 4 }"
)


def column_key(value: Any) -> str | int:
    """Return the name or number of a column; raise `ValueError` for something else."""
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise ValueError(f"expected {COLUMN}")
    if isinstance(value, int) and value < 1:
        raise ValueError("columns, channels and sheets are counted from 1")
    return value


def _columns(value: Any) -> dict[str, str | int]:
    if not isinstance(value, dict | list):
        raise ValueError(f"expected {_COLUMNS}")
    return {
        name: column_key(column) for name, column in FileLayout(columns=value).by_quantity.items()
    }


ColumnKey = Annotated[str | int, Reading(COLUMN, column_key)]
Columns = Annotated[dict[str, str | int], Reading(_COLUMNS, _columns)]
