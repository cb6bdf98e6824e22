#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of the exact unit between AXI4-Streams, by cocotb: axis_test.py NAME, in the folder that
`burnish hw generate --axis --name NAME` wrote. Exits with 1 if a test fails. AXIS_SIMULATOR: icarus (default) or
verilator."""
import os
import pathlib
import random
import sys

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge, ReadOnly, RisingEdge, Timer

NAME = os.environ.get("AXIS_NAME", "")


def golden():
    """The vectors as (s_axis_tdata, m_axis_tdata)."""
    lines = pathlib.Path(NAME + "_golden.mem").read_text().splitlines()
    words = [line for line in lines if line and not line.startswith("//")]
    # three digits of exponent, the input, four digits of value
    return [((int(word[3:-4], 16) << 16) | int(word[:3], 16), int(word[-4:], 16)) for word in words]


def clocks(dut):
    """The latency, from the comment that the module's file has."""
    text = pathlib.Path(NAME + ".sv").read_text()
    return int(text.split(" clocks.")[0].split()[-1])


async def start(dut):
    dut.aresetn.value = 0
    dut.s_axis_tvalid.value = 0
    dut.s_axis_tdata.value = 0
    dut.s_axis_tlast.value = 0
    dut.s_axis_tuser.value = 0
    dut.m_axis_tready.value = 0
    cocotb.start_soon(Clock(dut.aclk, 10, unit="ns").start())
    await Timer(25, unit="ns")
    await FallingEdge(dut.aclk)
    dut.aresetn.value = 1


async def exchange(dut, vectors, offers, takes, seed=1):
    """Sends the vectors, each offered with probability `offers` a clock and taken with `takes`. Checks values, order,
    tlast, tuser, and that what waits stays. Returns the clocks on which questions and answers moved."""
    chance = random.Random(seed)
    beside = [(chance.getrandbits(1), chance.getrandbits(1)) for _ in vectors]
    sent, received, sent_at, received_at, waits, clock = 0, 0, [], [], None, 0
    while received < len(vectors):
        # a question that is offered stays until it is taken
        if not int(dut.s_axis_tvalid.value) and sent < len(vectors) and chance.random() < offers:
            dut.s_axis_tdata.value = vectors[sent][0]
            dut.s_axis_tlast.value, dut.s_axis_tuser.value = beside[sent]
            dut.s_axis_tvalid.value = 1
        dut.m_axis_tready.value = int(chance.random() < takes)
        await ReadOnly()
        takes_question = int(dut.s_axis_tvalid.value) and int(dut.s_axis_tready.value)
        valid = int(dut.m_axis_tvalid.value)
        parts = (dut.m_axis_tdata, dut.m_axis_tlast, dut.m_axis_tuser)
        answer = tuple(int(part.value) for part in parts) if valid else None
        if waits is not None:
            assert answer == waits, f"answer {received} waited as {waits} and became {answer}"
        gives = valid and int(dut.m_axis_tready.value)
        if gives:
            assert received < sent, "an answer without a question"
            assert answer == (vectors[received][1], *beside[received]), f"answer {received}"
            received_at.append(clock)
            received += 1
        waits = answer if valid and not gives else None
        if takes_question:
            sent_at.append(clock)
            sent += 1
        await FallingEdge(dut.aclk)
        if takes_question:
            dut.s_axis_tvalid.value = 0
            await Timer(1, unit="ps")
        clock += 1
        assert clock < 40 * len(vectors) + 200, f"only {received} of {len(vectors)} answers"
    return sent_at, received_at


@cocotb.test()
async def one_result_a_clock_after_a_fixed_latency(dut):
    await start(dut)
    sent, received = await exchange(dut, golden(), 1, 1)
    assert sent == list(range(sent[0], sent[0] + len(sent))), "a pause without back-pressure"
    assert {b - a for a, b in zip(sent, received)} == {clocks(dut)}, "the latency is not what the module says"


@cocotb.test()
async def values_and_side_bands_survive_pauses(dut):
    for seed, (offers, takes) in enumerate([(0.5, 0.5), (1, 0.3), (0.3, 1), (0.9, 0.9)]):
        await start(dut)
        await exchange(dut, golden()[:200], offers, takes, seed)


@cocotb.test()
async def ready_waits_for_no_input(dut):
    """tready stays as it is when m_axis_tready changes within a clock, and so does tvalid with s_axis_tvalid."""
    await start(dut)
    vectors = golden()
    for step in range(60):
        dut.s_axis_tdata.value = vectors[step][0]
        seen = set()
        for valid, ready in ((0, 0), (1, 0), (0, 1), (1, step % 3 == 0)):
            dut.s_axis_tvalid.value = valid
            dut.m_axis_tready.value = int(ready)
            await Timer(1, unit="ns")
            seen.add((int(dut.s_axis_tready.value), int(dut.m_axis_tvalid.value)))
        assert len(seen) == 1, seen
        await FallingEdge(dut.aclk)


@cocotb.test()
async def reset_empties_it(dut):
    await start(dut)
    dut.m_axis_tready.value = 0
    dut.s_axis_tvalid.value = 1
    for _ in range(clocks(dut) + 5):
        await RisingEdge(dut.aclk)
    await FallingEdge(dut.aclk)
    assert int(dut.m_axis_tvalid.value) == 1 and int(dut.s_axis_tready.value) == 0, "it took more than it holds"
    await start(dut)
    await ReadOnly()
    assert int(dut.m_axis_tvalid.value) == 0 and int(dut.s_axis_tready.value) == 1
    await FallingEdge(dut.aclk)
    await exchange(dut, golden()[:50], 1, 1)


if __name__ == "__main__":
    from cocotb_tools.check_results import get_results
    from cocotb_tools.runner import get_runner

    name = sys.argv[1]
    listed = [line for line in pathlib.Path(name + ".f").read_text().splitlines() if not line.startswith("//")]
    runner = get_runner(os.environ.get("AXIS_SIMULATOR", "icarus"))
    runner.build(sources=[pathlib.Path(file).resolve() for file in listed], hdl_toplevel=name, build_dir="cocotb_build",
                 always=True, timescale=("1ns", "1ps"))
    results = runner.test(hdl_toplevel=name, test_module="axis_test", build_dir="cocotb_build",
                          test_dir=pathlib.Path.cwd(),
                          extra_env={"AXIS_NAME": name, "PYTHONPATH": str(pathlib.Path(__file__).resolve().parent)})
    tests, failures = get_results(results)
    print(f"cocotb, {name}: {tests} tests, {failures} failures")
    sys.exit(1 if failures or not tests else 0)
