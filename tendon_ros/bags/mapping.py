"""
The mapping file of ``tendon import``: how a foreign file becomes channels.

.. code-block:: yaml

    format: npz                  # npz, csv, mat or json
    runs: {include: '[0-9][0-9]', header: 'hdr_{key}'}
    time: {column: 0, unit: s}   # or {rate: 1000 Hz} where the file has no time
    epoch: 2017-06-01T00:00:00Z  # when time zero was; one second after 1970 began by default
    channels:
      actuator/pulley_motor/position:
        column: 8                # number counted from 0, or a name
        unit: turn / (4096 * 35) # what one step of the raw number is
        scale: 1.0               # a further factor
        sign: -1                 # turns the direction
        offset: -180 deg         # added last; a number alone is in the channel's SI unit
        bits: 16                 # where a signed register was logged without its sign
        wrap: 360 deg            # where the channel begins anew after so much, before scale
        time: {column: 9, unit: us}  # where the channel has stamps of its own
    metadata: {tool: Maryland}
    attribution: Who made the data, where it was published.
    licence: ODbL 1.0

``value = sign · scale · unit · raw + offset``. ``runs`` is for files that hold one table a run;
without it the file is one run, and a column is one array of the file. An empty cell is a sample
that was not taken; with stamps of its own, a row that repeats the channel's last one is none. With
``bits``, raw numbers from the upper half of the register's range are negative ones. With ``wrap``,
a change by more than half of it from one sample to the next is taken for a turn. A JSON file holds
a list of samples, each an object of numbers, or a list of numbers for each column.
"""

from __future__ import annotations

from datetime import datetime, UTC
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    field_validator,
    model_validator,
    ValidationError,
)
import yaml

from tendon_ros.bags.topics import place_of
from tendon_ros.base.errors import listed, RecordingError, TendonError
from tendon_ros.base.quantity import factor, parsed
from tendon_ros.base.recording import unit_of
from tendon_ros.base.resources import installed, installed_names
from tendon_ros.base.yaml_keys import UniqueKeys

Column = Annotated[int, Field(ge=0, strict=True)] | Annotated[str, Field(min_length=1)]

#: a number with its unit; one without a unit is told so, not that it is no text
Quantity = Annotated[
    str, BeforeValidator(lambda given: str(given) if isinstance(given, int | float) else given)
]

#: what one step of a raw number may be, by the unit of its channel
EXAMPLES = {'rad': 'turn / 4096', 'N m': 'mA * 0.08 N m/A'}

#: years of an epoch: time that counts from one of them fits into 64 bits of nanoseconds
EARLIEST, LATEST = 1700, 2037


def _checked(text: str, target: str) -> None:
    """Complain of a unit that is of another kind; say how a straight axis writes its own."""
    try:
        factor(text, target)
    except ValueError as error:
        turned = f'{text} * rad/m' if target.startswith('rad') else f'{text} * m'
        try:
            factor(turned, target)
        except ValueError:
            example = EXAMPLES.get(target, target)
            raise ValueError(
                f'{error}; write what one of the number is, such as {example!r}'
            ) from None
        raise ValueError(f'{error}: write {turned!r}') from None


class _Loader(UniqueKeys, yaml.SafeLoader):
    """The usual loader, made to refuse a key given twice."""


class _Strict(BaseModel):
    model_config = ConfigDict(extra='forbid', frozen=True, allow_inf_nan=False)


class Runs(_Strict):
    """Which arrays of the file are runs, and which text belongs to them."""

    include: str = '*'
    exclude: str = ''
    header: str = ''

    @field_validator('header')
    @classmethod
    def _names_key(cls, value: str) -> str:
        if value and '{key}' not in value:
            raise ValueError("must hold {key}, for instance 'hdr_{key}'")
        return value


class Time(_Strict):
    """Where the time comes from: a column, or a constant rate."""

    column: Column | None = None
    unit: str = 's'
    rate: Quantity | None = None

    @field_validator('unit')
    @classmethod
    def _is_time(cls, value: str) -> str:
        _checked(value, 's')
        return value

    @field_validator('rate')
    @classmethod
    def _is_rate(cls, value: str | None) -> str | None:
        if value is None:
            return None
        try:
            rate = factor(value, 'Hz')
        except ValueError as error:
            raise ValueError(f"{error}; write a rate such as '1 kHz'") from None
        if rate < 0.0:
            raise ValueError(f'{value!r} is negative')
        return value

    @model_validator(mode='after')
    def _one_of(self) -> Time:
        if (self.column is None) == (self.rate is None):
            raise ValueError('give either a column or a rate')
        return self


class Source(_Strict):
    """Where a channel comes from; see the module for the formula."""

    column: Column
    unit: str
    scale: float = 1.0
    sign: Literal[1, -1] = 1
    offset: float | str = 0.0
    bits: Annotated[int, Field(ge=2, le=64, strict=True)] | None = None
    wrap: Quantity | None = None
    time: Time | None = None

    @field_validator('scale')
    @classmethod
    def _not_zero(cls, value: float) -> float:
        if value == 0.0:
            raise ValueError('must not be 0')
        return value


class Mapping(_Strict):
    """A mapping file."""

    format: Literal['npz', 'csv', 'mat', 'json']
    runs: Runs | None = None
    time: Time
    epoch: datetime = datetime(1970, 1, 1, 0, 0, 1, tzinfo=UTC)
    channels: dict[str, Source] = Field(min_length=1)
    metadata: dict[str, str] = {}
    attribution: str = ''
    licence: str = ''

    @field_validator('epoch')
    @classmethod
    def _in_utc(cls, value: datetime) -> datetime:
        if not EARLIEST <= value.year <= LATEST:
            raise ValueError(f'must lie in the years {EARLIEST} to {LATEST}')
        return value if value.tzinfo else value.replace(tzinfo=UTC)

    @field_validator('channels')
    @classmethod
    def _known(cls, value: dict[str, Source]) -> dict[str, Source]:
        for name, source in value.items():
            try:
                place_of(name)
                _checked(source.unit, unit_of(name))
            except (RecordingError, ValueError) as error:
                raise ValueError(f'{name}: {error}') from error
            for field, given in (('offset', source.offset), ('wrap', source.wrap)):
                try:
                    if isinstance(given, str):
                        read = parsed(given, unit_of(name))
                        if field == 'wrap' and read <= 0.0:
                            raise ValueError(f'{given!r} must be more than 0')
                except ValueError as error:
                    raise ValueError(f'{name}.{field}: {error}') from error
        if not any(name.startswith('actuator/') for name in value):
            raise ValueError(f'none of {listed(value)} is of the motors; map actuator/JOINT/FIELD')
        return value

    @model_validator(mode='after')
    def _runs_fit(self) -> Mapping:
        if self.runs is not None and self.format in ('csv', 'json'):
            raise ValueError(f'runs: a {self.format.upper()} file is one run; leave it out')
        return self


def load_mapping(path: Path | str) -> Mapping:
    """
    Read and check a mapping file.

    :param path: YAML file, or the name of a mapping that comes with the package.
    :return: the mapping.
    :raises RecordingError: on the first fault, with file, field and mend.
    """
    try:
        file = installed(path, 'imports') or Path(path)
        data: Any = yaml.load(file.read_text(encoding='utf-8'), _Loader)
        if not isinstance(data, dict):
            raise TendonError('no fields; a mapping needs format, time and channels')
        return Mapping.model_validate(data)
    except OSError as error:
        raise RecordingError(
            f'{path}: cannot be read ({error.strerror}); give the path of a mapping file, or one '
            f'of the mappings {installed_names("imports")}'
        ) from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        detail = ' '.join(str(error).split())
        raise RecordingError(f'{path}: not YAML ({detail}); mend the line') from error
    except ValidationError as error:
        raise RecordingError(f'{path}: {_sentence(error)}') from error
    except TendonError as error:
        raise RecordingError(f'{path}: {error}') from None


def _sentence(error: ValidationError) -> str:
    """Return the first fault that pydantic found, with its mend."""
    fault = error.errors()[0]
    place = '.'.join(str(part) for part in fault['loc']) or 'mapping'
    if fault['type'] == 'extra_forbidden':
        models: dict[str, type[_Strict]] = {'runs': Runs, 'time': Time, 'channels': Source}
        above = [str(part) for part in fault['loc'][:-1]]
        # a channel may have times of its own
        model = next((models[part] for part in reversed(above) if part in models), Mapping)
        return f'{place}: unknown field; use {listed(model.model_fields)}'
    if fault['type'] == 'missing':
        return f'{place}: missing; add it'
    message = fault['msg'].removeprefix('Value error, ')
    return f'{place}: {message[0].lower()}{message[1:]}'
