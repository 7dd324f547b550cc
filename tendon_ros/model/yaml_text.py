"""
YAML as text: every scalar stays the text that the user wrote.

So ``1e-3`` is not a string by accident, ``012`` not octal, a pulley called ``on`` not ``True``.
What a text means is decided by the field that it fills. Keys given twice are an error.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from tendon_ros.base.errors import InstrumentError, TendonError
from tendon_ros.base.yaml_keys import UniqueKeys


class _TextLoader(UniqueKeys, yaml.BaseLoader):
    """PyYAML's loader that converts nothing, made to refuse a key given twice."""


def read_mapping(path: Path) -> dict[str, Any]:
    """
    Return a YAML file's top-level mapping with every scalar as text.

    :param path: the file.
    :return: nested dicts, lists and texts.
    :raises InstrumentError: where the file cannot be read, is not YAML, or gives a key twice.
    """
    try:
        text = path.read_text(encoding='utf-8')
    except OSError as error:
        raise InstrumentError(f'{path}: {error.strerror}; give an existing YAML file') from None
    except UnicodeDecodeError:
        raise InstrumentError(f'{path}: is not UTF-8 text; give a YAML file') from None
    return mapping_of(text, path)


def mapping_of(text: str, path: Path) -> dict[str, Any]:
    """
    Return the top-level mapping of a YAML text with every scalar as text.

    :param text: the YAML.
    :param path: where it stands, for messages.
    :return: nested dicts, lists and texts.
    :raises InstrumentError: where it is not YAML, or gives a key twice.
    """
    try:
        document = yaml.load(text, _TextLoader)
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        raise InstrumentError(
            f'{path}: line {line}: {error.problem}; mend the YAML there'
        ) from None
    except yaml.YAMLError as error:
        raise InstrumentError(f'{path}: {str(error).splitlines()[0]}; mend the YAML') from None
    except TendonError as error:
        raise InstrumentError(f'{path}: {error}') from None
    if not isinstance(document, dict):
        raise InstrumentError(f'{path}: holds no `key: value` pairs at its top; give some')
    return document
