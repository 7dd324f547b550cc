"""YAML in which a key given twice is an error; PyYAML alone would take the last one."""

from __future__ import annotations

from typing import Any, TYPE_CHECKING

import yaml

from tendon_ros.base.errors import TendonError

if TYPE_CHECKING:
    _Composer = yaml.composer.Composer
else:
    _Composer = object


class UniqueKeys(_Composer):
    """What a loader of PyYAML takes as its first base to refuse a key given twice."""

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        """
        Return the node of a mapping; here, before ``<<`` is resolved, it is as the user wrote it.

        :param anchor: as PyYAML gives it.
        :return: the node.
        :raises TendonError: on a key given twice, or that is no plain text.
        """
        node = super().compose_mapping_node(anchor)
        seen: set[str] = set()
        for key, _ in node.value:
            line = key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                raise TendonError(f'line {line}: a key is not plain text; write `name: value`')
            if key.value in seen:
                raise TendonError(f'line {line}: {key.value}: is given twice; keep one of the two')
            seen.add(key.value)
        return node
