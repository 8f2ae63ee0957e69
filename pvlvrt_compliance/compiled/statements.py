"""Statements of a module's text by the names that they bind, and the names that decide what is bound."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ALL = "*"
"""Stands for every name of a module."""


class Imported(NamedTuple):
    """What an import statement binds a name to."""

    module: str
    name: str  # of something in the module; empty for the module itself


class Used(NamedTuple):
    """A name that a statement reads."""

    name: str
    part: str  # attribute of it that is read; `ALL` where more than one attribute is handed on


class Statement:
    """One statement at the top of a module, with all that is within it."""

    def __init__(self, node: ast.stmt, package: str) -> None:
        self.imported: dict[str, Imported] = {}
        self.starred: list[str] = []  # modules of which everything is imported
        self.used: set[Used] = set()
        self._package = package
        self._bound: set[str] = set()
        self._global: set[str] = set()
        self._in_attributes: set[int] = set()
        for inner in ast.walk(node):  # an attribute comes before the name that it is one of
            self._take(inner)
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            self.bound = {node.name} | self._global  # everything else is bound within
        elif _changes_in_place(node):
            self.bound = self._bound | set(self.imported) | {used.name for used in self.used}
        else:
            self.bound = self._bound | set(self.imported)

    def _take(self, node: ast.AST) -> None:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            self._in_attributes.add(id(node.value))
            self.used.add(Used(node.value.id, node.attr))
        elif isinstance(node, ast.Name):
            self._take_name(node)
        elif isinstance(node, ast.Global):
            self._global |= set(node.names)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            self._bound.add(node.name)
        elif isinstance(node, ast.Import):
            for alias in node.names:
                top = alias.name.partition(".")[0]
                self.imported[alias.asname or top] = Imported(alias.name if alias.asname else top, "")
        elif isinstance(node, ast.ImportFrom):
            self._take_import(node)

    def _take_name(self, node: ast.Name) -> None:
        if not isinstance(node.ctx, ast.Load):
            self._bound.add(node.id)
        elif id(node) not in self._in_attributes:
            self.used.add(Used(node.id, ALL))

    def _take_import(self, node: ast.ImportFrom) -> None:
        module = node.module or ""
        if node.level:
            parents = self._package.split(".")
            module = ".".join([*parents[: len(parents) - node.level + 1], *([module] if module else [])])
        for alias in node.names:
            if alias.name == ALL:
                self.starred.append(module)
            else:
                self.imported[alias.asname or alias.name] = Imported(module, alias.name)


def _changes_in_place(node: ast.stmt) -> bool:
    """Whether a statement may change what a name stands for without binding it: ``table["x"] = 1``, ``add(table)``."""
    for inner in ast.walk(node):
        if isinstance(inner, ast.Expr) and not isinstance(inner.value, ast.Constant):
            return True
        if isinstance(inner, ast.Subscript | ast.Attribute | ast.AugAssign) and _is_written(inner):
            return True
    return False


def _is_written(node: ast.Subscript | ast.Attribute | ast.AugAssign) -> bool:
    return isinstance(node, ast.AugAssign) or not isinstance(node.ctx, ast.Load)


class Text:
    """The statements of a module."""

    def __init__(self, module: str, file: str) -> None:
        self.module = module
        self.is_package = Path(file).name == "__init__.py"
        package = module if self.is_package else module.rpartition(".")[0]
        self.statements = [Statement(node, package) for node in ast.parse(Path(file).read_bytes()).body]
        self._imported = {name: target for x in self.statements for name, target in x.imported.items()}

    def binding(self, name: str) -> list[Statement]:
        """Statements that bind a name, or change what it stands for."""
        return [x for x in self.statements if name == ALL or name in x.bound]

    def behind(self, name: str) -> Iterator[tuple[str, str]]:
        """Names, as (module, name), that decide what a name of this module stands for."""
        binding = self.binding(name)
        if not binding:
            yield from ((module, name) for x in self.statements for module in x.starred)
            if self.is_package:
                yield f"{self.module}.{name}", ALL
        for x in binding:
            imported = self._imported | x.imported
            yield from (imported[bound] for bound in ({name} if name != ALL else x.bound) & set(x.imported))
            for used in x.used:
                yield from self._read(used, imported.get(used.name))

    def _read(self, used: Used, imported: Imported | None) -> Iterator[tuple[str, str]]:
        if imported is None:
            yield self.module, used.name
        elif imported.name:
            yield imported
            yield f"{imported.module}.{imported.name}", used.part  # if that is a module
        else:
            yield imported.module, used.part


@cache
def text_of(module: str, file: str) -> Text:
    """Read a module's text, once."""
    return Text(module, file)
