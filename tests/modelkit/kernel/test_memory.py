"""Machine code and memory by address: what comes back is what was there, and failures are no crashes."""

from __future__ import annotations

import ctypes

import numpy as np
from numba import carray, cfunc, njit, types

from touchdown.fmus.recipes import recipe
from touchdown.modelkit.instance import Instance, stop_reason
from touchdown.modelkit.kernel.memory import (
    advance_address,
    call_advance,
    call_exchange,
    call_step,
    float64_at,
    int32_at,
)

STEP = 2e-5  # s


@njit
def steps(address, words, work, count):
    """So many macro steps; the last status."""
    status = 0
    for k in range(count):
        status = call_advance(address, words, work, k * STEP, STEP)
    return status


def test_a_model_by_address_steps_as_it_does_by_name() -> None:
    by_name, by_address = (Instance(recipe("housing").model) for _ in range(2))
    for instance in (by_name, by_address):
        instance.start(0.0)
        instance.words[next(s.index for s in instance.slots if s.variable.name == "seat.fx")] = 100.0
    for k in range(20):
        by_name.step(k * STEP, STEP)
    address = advance_address(by_address.model.advance)
    assert steps(address, by_address.words, by_address.work, 20) == 0
    assert by_address.words.tobytes() == by_name.words.tobytes()
    assert by_name.record["q"].any()


def test_an_exception_is_a_status_that_is_said() -> None:
    """It would end nothing but the thread that it is raised in."""

    @njit
    def advance(words, work, time, step):
        if step > 0.0:
            raise ValueError("as it raised")
        return 0

    words, work = np.zeros(1), np.zeros((1, 1))
    advance(words, work, 0.0, 0.0)
    assert steps(advance_address(advance), words, work, 1) == -1
    housing = Instance(recipe("housing").model)
    assert stop_reason(housing, -1, 1e-3, STEP).startswith("the model's code gave up at t = 0.001 s")


def test_functions_of_fmi_get_what_they_are_given() -> None:
    """Addresses and a count, time and step; their answer is an int of C, with its sign."""
    size = types.uintp

    @cfunc(types.int32(size, types.CPointer(types.uint32), size, types.CPointer(types.float64)))
    def exchange(component, references, count, values):
        given, numbers = carray(values, count), carray(references, count)
        for i in range(count):
            given[i] += 10.0 * numbers[i]
        return -types.int32(component)

    @cfunc(types.int32(size, types.float64, types.float64, types.int32))
    def step(component, time, step, kept):
        return types.int32(1000 * component + 100 * time + 10 * step + kept)

    @njit
    def called(set_real, do_step, references, values):
        answer = call_exchange(set_real, 7, references, 3, values)
        return answer, call_step(do_step, 2, 3.0, 4.0)

    references, values = np.array([1, 2, 3], np.uint32), np.array([0.5, 0.25, 0.125])
    answers = called(exchange.address, step.address, references.ctypes.data, values.ctypes.data)
    assert answers == (-7, 2341)
    assert list(values) == [10.5, 20.25, 30.125]


def test_arrays_at_addresses_are_what_stands_there() -> None:
    @njit
    def changed(address, integers):
        table, numbers = float64_at(address, (2, 3)), int32_at(integers, 2)
        table[1, 2] += numbers[1]
        return table.sum()

    table, numbers = np.arange(6.0).reshape(2, 3), (ctypes.c_int32 * 2)(5, -4)
    assert changed(table.ctypes.data, ctypes.addressof(numbers)) == 11.0
    assert table[1, 2] == 1.0
