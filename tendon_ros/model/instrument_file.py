"""
Instrument files: find, read and write.

The form is that of :mod:`tendon_ros.model.instrument_schema`. ``base: FILE`` at the top of a file
takes everything from another one and overrides what is given; a curve may be a file of its own.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import ValidationError

from tendon_ros.base.errors import InstrumentError
from tendon_ros.base.resources import installed, installed_names
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.instrument_build import built
from tendon_ros.model.instrument_schema import CurveSection, InstrumentSection, Section
from tendon_ros.model.instrument_text import text_of
from tendon_ros.model.yaml_text import mapping_of, read_mapping


def find_instrument(name_or_path: str | Path) -> Path:
    """
    Return the file of an instrument.

    :param name_or_path: a path, or the name of an instrument that comes with the package.
    :return: an existing file.
    :raises InstrumentError: where there is none; the message lists the instruments that exist.
    """
    path = installed(name_or_path, 'instruments')
    if path is None:
        raise InstrumentError(
            f'{name_or_path}: no such file; give a path, or one of the instruments '
            f'{installed_names("instruments")}'
        )
    return path


def load_instrument(name_or_path: str | Path) -> Instrument:
    """
    Return the instrument of a file.

    :param name_or_path: as for :func:`find_instrument`.
    :return: the instrument; its name is the file's where it gives none.
    :raises InstrumentError: on anything wrong in the file: one line with file, field and mend.
    """
    path = find_instrument(name_or_path)
    document = _with_base(path)
    document.setdefault('name', path.stem)
    return _built(path, document)


def save_instrument(instrument: Instrument, path: Path) -> None:
    """
    Write an instrument to a file of its own that :func:`load_instrument` reads as the same.

    :param instrument: the instrument.
    :param path: the file; its folder must exist.
    :raises InstrumentError: where the instrument has something that no file can describe, or the
        file cannot be written.
    """
    text = text_of(instrument)
    if _built(path, mapping_of(text, path)) != instrument:
        raise InstrumentError(
            f'{path}: {instrument.name} has something that a file cannot describe; give each '
            'motor an encoder and a torque sensor, name sensors as load_instrument does, and give '
            'tolerances only for numbers that the file may give them'
        )
    try:
        path.write_text(text, encoding='utf-8')
    except OSError as error:
        raise InstrumentError(f'{path}: {error.strerror}; choose a place to write to') from None


def _built(path: Path, document: dict[str, Any]) -> Instrument:
    section = _validated(path, InstrumentSection, document)
    try:
        return built(section)
    except InstrumentError as error:
        raise InstrumentError(f'{path}: {error}') from None


def _with_base(path: Path) -> dict[str, Any]:
    """Read a file with the files that it refers to put in their places."""
    document = read_mapping(path)
    base = document.pop('base', None)
    _insert_curves(path, document)
    if base is None:
        return document
    if not isinstance(base, str):
        raise InstrumentError(f'{path}: base: is no file name; write `base: paper_rig.yaml`')
    beside = path.parent / base
    try:
        below_path = beside if beside.is_file() else find_instrument(base)
    except InstrumentError as error:
        raise InstrumentError(f'{path}: base: {error}') from None
    below = read_mapping(below_path)
    if 'base' in below:
        raise InstrumentError(
            f'{path}: base: {below_path} has a base itself; only one level is read, name that one'
        )
    _insert_curves(below_path, below)
    below.pop('name', None)
    below.pop('description', None)
    return _merged(below, document)


def _merged(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Return one mapping overridden by another, key by key, sections within sections."""
    result = dict(below)
    for key, value in above.items():
        old = result.get(key)
        both = isinstance(old, dict) and isinstance(value, dict) and key not in _WHOLE
        result[key] = _merged(old, value) if both else value  # type: ignore[arg-type]
    return result


#: what is replaced, not merged: a table in mm does not mix with one in m
_WHOLE = {'elongation', 'tension'}


def _insert_curves(path: Path, document: dict[str, Any]) -> None:
    """Replace ``{file: NAME}`` among the curves by what that file holds."""
    curves = document.get('curves')
    if not isinstance(curves, dict):
        return
    for name, section in curves.items():
        if not isinstance(section, dict) or 'file' not in section:
            continue
        field = f'{path}: curves.{name}'
        if len(section) > 1 or not isinstance(section['file'], str):
            raise InstrumentError(
                f'{field}: give either `file: NAME.yaml` or elongation and tension'
            )
        file = path.parent / section['file']
        if not file.is_file():
            raise InstrumentError(
                f'{field}.file: {file} does not exist; give a path relative to {path.parent}'
            )
        content = read_mapping(file)
        _validated(file, CurveSection, content)
        curves[name] = content


def _validated[S: Section](path: Path, kind: type[S], document: dict[str, Any]) -> S:
    """Return the sections of a document, or raise its first fault as one line."""
    try:
        return kind.model_validate(document)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        context = first.get('ctx', {})
        field = [str(part) for part in first['loc'] if part != '[key]']
        if 'key' in context:
            field.append(str(context['key']))
        message = first['msg'].removeprefix('Value error, ')
        if first['type'] not in {'value_error', 'section', 'key'}:
            message = f'{first["input"]!r}: {message[0].lower()}{message[1:]}'
        place = f'{path}: {".".join(field)}' if field else str(path)
        raise InstrumentError(f'{place}: {message}') from None
