"""Object code of a function, and of its entry, which takes and gives words (`flat`): made by numba.

Only this module of them imports numba: what is kept needs none.
"""

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numba
from llvmlite import binding, ir  # type: ignore[import-untyped]
from numba.core import cgutils as numbas_instructions
from numba.core import types as numbas_types
from numba.np import arrayobj

from pvlvrt_compliance.compiled.flat import NONE, NotFlatError
from pvlvrt_compliance.compiled.loading import ObjectCode

types: Any = numbas_types  # as they are made while the program runs
cgutils: Any = numbas_instructions
populate_array: Any = arrayobj.populate_array
njit: Any = numba.njit
typeof: Any = numba.typeof

_WORD = ir.IntType(64)
_POINTER = ir.IntType(8).as_pointer()
_ENTRY = "entry_of_words"
_END_OF_MEMORY = "NRT_MemInfo_call_dtor"  # called by whoever is the last to know a piece of memory of compiled code's


def compiled(function: Callable[..., Any], arguments: tuple[Any, ...], options: dict[str, Any]) -> ObjectCode:
    """Compile a function for arguments of these types.

    Raises
    ------
    NotFlatError
        When what it returns is nothing but for numba.
    """
    made: Any = njit(function, no_cpython_wrapper=True, no_cfunc_wrapper=True, **options)
    signature = tuple(typeof(x) for x in arguments)
    with _nothing_collected():
        made.compile(signature)
    result = made.overloads[signature]
    returned = _written(result.signature.return_type)
    codegen, needs = result.target_context.codegen(), {*_needed(result.library._final_module)}
    memory = {name for name in needs if name.startswith("NRT_")}
    given = result.signature.return_type
    if isinstance(given, types.Array) or (memory - {_END_OF_MEMORY} and _holds_array(given)):
        raise NotFlatError("an array")
    module = _entry(result)
    if memory == {_END_OF_MEMORY}:
        needs.remove(_END_OF_MEMORY)
        _define_nothing(module, _END_OF_MEMORY)
    entry = binding.parse_assembly(str(module))
    entry.verify()
    passes, builder = codegen._module_pass_manager()
    passes.run(entry, builder)
    objects = (result.library._get_compiled_object(), codegen._tm.emit_object(entry))
    return ObjectCode(_ENTRY, returned, sorted(needs), objects)


@contextmanager
def _nothing_collected() -> Iterator[None]:
    """What numba builds lasts to the end: to look through it again and again for garbage takes a tenth of the time."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()


def _needed(module: Any) -> Iterator[str]:
    """Names of what code takes from elsewhere."""
    for x in (*module.functions, *module.global_variables):
        if x.is_declaration and not x.name.startswith("llvm."):
            yield x.name


def _entry(result: Any) -> ir.Module:
    """``int32_t entry(const void *words, void *result)``: 0 when all is well, else the exception is the result."""
    context, names = result.target_context, result.fndesc
    module = context.codegen()._create_empty_module(_ENTRY)
    called = ir.Function(
        module, context.call_conv.get_function_type(names.restype, names.argtypes), names.llvm_func_name
    )
    entry = ir.Function(module, ir.FunctionType(ir.IntType(32), [_POINTER, _POINTER]), _ENTRY)
    builder = ir.IRBuilder(entry.append_basic_block())
    given, taken = (_Words(context, builder, argument) for argument in entry.args)
    arguments = [given.read(of) for of in names.argtypes]
    status, value = context.call_conv.call_function(builder, called, names.restype, names.argtypes, arguments)
    with builder.if_then(status.is_user_exc):
        raised = builder.load(status.excinfoptr)
        taken.put(builder.extract_value(raised, 0))
        taken.put(builder.zext(builder.extract_value(raised, 1), _WORD))
    taken.at = 0
    with builder.if_then(status.is_ok):
        taken.write(names.restype, value)
    builder.ret(builder.select(status.is_ok, ir.IntType(32)(0), ir.IntType(32)(1)))
    return module


def _define_nothing(module: ir.Module, name: str) -> None:
    """Define a function that is never called: all arrays are the caller's, and none is made."""
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), [_POINTER]), name)
    ir.IRBuilder(function.append_basic_block()).ret_void()


class _Words:
    """Instructions that read or write words, one after another."""

    def __init__(self, context: Any, builder: ir.IRBuilder, pointer: ir.Value) -> None:
        self._context = context
        self._builder = builder
        self._pointer = pointer
        self.at = 0  # bytes

    def _place(self, of: ir.Type, size: int) -> ir.Value:
        place = self._builder.gep(self._pointer, [ir.IntType(32)(self.at)])
        self.at += size
        return self._builder.bitcast(place, of.as_pointer())

    def get(self, of: ir.Type, size: int = 8) -> ir.Value:
        """Read what may be less than a word."""
        return self._builder.load(self._place(of, size))

    def put(self, value: ir.Value, size: int = 8) -> None:
        """Write what may be less than a word."""
        self._builder.store(value, self._place(value.type, size))

    def read(self, of: Any) -> ir.Value:
        """Read a value of a type of numba's."""
        context, builder = self._context, self._builder
        if isinstance(of, types.NoneType):
            return context.get_dummy_value()
        if isinstance(of, types.BaseTuple):
            return context.make_tuple(builder, of, [self.read(part) for part in of])
        if isinstance(of, types.Array):
            return self._read_array(of)
        if isinstance(of, types.Boolean):
            return builder.trunc(self.get(ir.IntType(8)), ir.IntType(1))
        if isinstance(of, types.Complex):
            part = context.get_value_type(of.underlying_float)
            value = context.make_complex(builder, of)
            value.real, value.imag = (self.get(part, of.bitwidth // 16) for _ in range(2))
            return value._getvalue()
        return self.get(context.get_value_type(of))

    def _read_array(self, of: Any) -> ir.Value:
        """Read an array of whose memory compiled code counts no references: who calls holds it."""
        context, builder = self._context, self._builder
        array = context.make_array(of)(context, builder)
        data = self.get(context.get_data_type(of.dtype).as_pointer())
        shape, strides = ([self.get(_WORD) for _ in range(of.ndim)] for _ in range(2))
        size = context.get_abi_sizeof(context.get_data_type(of.dtype))
        populate_array(array, data, shape, strides, size, None)
        return array._getvalue()

    def write(self, of: Any, value: ir.Value) -> None:
        """Write a value of a type of numba's."""
        context, builder = self._context, self._builder
        if isinstance(of, types.BaseTuple):
            for part, x in zip(of, cgutils.unpack_tuple(builder, value, len(of)), strict=True):
                self.write(part, x)
        elif isinstance(of, types.Complex):
            number = context.make_complex(builder, of, value=value)
            for x in (number.real, number.imag):
                self.put(x, of.bitwidth // 16)
        elif isinstance(of, types.Boolean):
            self.put(builder.zext(value, ir.IntType(8)))
        elif isinstance(of, types.Integer):
            self.put((builder.sext if of.signed else builder.zext)(value, _WORD) if of.bitwidth < 64 else value)
        elif not isinstance(of, types.NoneType | types.Array):  # an array is one of the caller's
            self.put(value)


def _holds_array(of: Any) -> bool:
    return isinstance(of, types.Array) or (isinstance(of, types.BaseTuple) and any(map(_holds_array, of)))


def _written(of: Any) -> Any:
    """Result of a type of numba's, as `flat.Result` reads it; an array is one of the caller's, who has it."""
    if isinstance(of, types.NoneType | types.Array):
        return NONE
    if isinstance(of, types.BaseTuple):
        kind = getattr(of, "instance_class", tuple)
        return [f"{kind.__module__}:{kind.__qualname__}", *map(_written, of)]
    if isinstance(of, types.Boolean):
        return "b1"
    if isinstance(of, types.Integer):
        return "i8" if of.signed else "u8"
    if isinstance(of, types.Float | types.Complex):
        return f"{'f' if isinstance(of, types.Float) else 'c'}{of.bitwidth // 8}"
    raise NotFlatError(str(of))
