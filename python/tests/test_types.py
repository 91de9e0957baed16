"""The file of types says of the compiled module what there is, by the same names, in the same order, with the same defaults."""

from __future__ import annotations

import ast
import inspect

import pytest
from conftest import ROOT

import mechc
from mechc import _mechc

STUB = ast.parse((ROOT / "python/mechc/_mechc.pyi").read_text())
TYPED = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}

#: What Python itself gives every class.
OF_ALL = set(dir(object)) | {"__module__", "__doc__", "__slotnames__"}


def members(kind):
    return {node.name: node for node in kind.body if isinstance(node, ast.FunctionDef)}


def is_property(node):
    return any(isinstance(of, ast.Name) and of.id == "property" for of in node.decorator_list)


def signature_of(node):
    """Names, kinds and defaults of a stub's function, without `self`."""
    of, kind = node.args, inspect.Parameter
    found = []
    names = [*((one, kind.POSITIONAL_ONLY) for one in of.posonlyargs), *((one, kind.POSITIONAL_OR_KEYWORD) for one in of.args)]
    defaults = [kind.empty] * (len(names) - len(of.defaults)) + [ast.literal_eval(one) for one in of.defaults]
    found += [(one.arg, how, default) for (one, how), default in zip(names, defaults)]
    for one, default in zip(of.kwonlyargs, of.kw_defaults):
        found.append((one.arg, kind.KEYWORD_ONLY, kind.empty if default is None else ast.literal_eval(default)))
    if of.kwarg:
        found.append((of.kwarg.arg, kind.VAR_KEYWORD, kind.empty))
    return [one for one in found if one[0] not in ("self", "cls")]


def signature_in_module(what):
    found = inspect.signature(what).parameters.values()
    return [(of.name, of.kind, of.default) for of in found if of.name not in ("self", "cls")]


def test_classes_are_those_of_the_module():
    there = {name for name, what in vars(_mechc).items() if inspect.isclass(what)}
    assert there == set(TYPED)
    functions = {name for name, what in vars(_mechc).items() if inspect.isbuiltin(what)}
    assert functions == set(FUNCTIONS)


@pytest.mark.parametrize("name", TYPED)
def test_members_and_signatures(name):
    kind, typed = getattr(_mechc, name), members(TYPED[name])
    own = {member for member in vars(kind) if member not in OF_ALL}
    # what slots bring along beside those that are typed
    own -= {"__delitem__", "__setitem__"} - set(typed)
    assert {member for member in typed if member not in OF_ALL} == own
    for member, node in typed.items():
        if member == "__new__":
            assert signature_of(node) == signature_in_module(kind)
        elif is_property(node):
            assert inspect.isgetsetdescriptor(vars(kind)[member]), member
        elif not member.startswith("__") or member.startswith("__arrow"):
            assert signature_of(node) == signature_in_module(getattr(kind, member)), member


def test_functions():
    for name, node in FUNCTIONS.items():
        assert signature_of(node) == signature_in_module(getattr(_mechc, name))


def test_what_users_call_says_shapes_and_units():
    """Each public member of the stub's public classes has words, and each that is an array its shape."""
    for name in ("At", "Mechanism"):
        for member, node in members(TYPED[name]).items():
            if member.startswith("_"):
                continue
            words = ast.get_docstring(node)
            assert words, f"{name}.{member}"
            is_array = isinstance(node.returns, ast.AST) and "NDArray" in ast.unparse(node.returns)
            assert not is_array or "shape" in words, f"{name}.{member}"


def test_all_that_is_public_has_words_and_types():
    for name in mechc.__all__:
        what = getattr(mechc, name)
        if name.startswith("__"):
            continue
        assert what.__doc__, name
        if inspect.isfunction(what):
            assert all(of.annotation is not of.empty for of in inspect.signature(what).parameters.values()), name
