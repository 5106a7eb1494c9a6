"""The CSR bus, with amaranth-soc's rules: data a cycle after the strobe, and 0 at other times."""

from __future__ import annotations

from amaranth.hdl import Module
from amaranth.lib.wiring import connect
from amaranth.sim import Simulator

from firm_hdl.node.gateware.registers import NodeRegisters
from firm_hdl.registers import CsrSlave, RegisterBlock, RegisterMap
from firm_hdl.registers.head import bits, control_register, identity_registers, word
from tests.node.samples import read


def test_words_are_read_and_written():
    table = RegisterMap(
        name="t",
        registers=(
            *identity_registers(5 << 32 | 4, ""),
            control_register(bits("pulse", "commit", 0, 1, ""), reset=""),
            word(0x14, "setting", "setting", "", 7),
        ),
        meaning="",
    )
    m = Module()
    m.submodules.slave = slave = CsrSlave(table.address_bits)
    m.submodules.block = block = RegisterBlock(table)
    connect(m, slave.bus, block.bus)
    csr = slave.csr

    async def bench(ctx):
        async def read(address):
            ctx.set(csr.addr, address // 4)
            ctx.set(csr.r_stb, 1)
            await ctx.tick()
            ctx.set(csr.r_stb, 0)
            found = ctx.get(csr.r_data)
            await ctx.tick()
            assert ctx.get(csr.r_data) == 0
            return found

        async def write(address, value):
            ctx.set(csr.addr, address // 4)
            ctx.set(csr.w_data, value)
            ctx.set(csr.w_stb, 1)
            await ctx.tick()
            ctx.set(csr.w_stb, 0)

        assert [await read(4 * k) for k in range(4)] == [0x4D524946, 1 << 16, 4, 5]
        assert await read(0x14) == 7
        await write(0x14, 0xDEADBEEF)
        assert await read(0x14) == 0xDEADBEEF
        await write(0x08, 1)
        assert await read(0x08) == 4
        assert await read(0x100) == 0
        await write(0x10, 1)
        assert ctx.get(block.control_commit) == 1
        await ctx.tick()
        assert ctx.get(block.control_commit) == 0

    simulator = Simulator(m)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()


def test_a_node_behind_it_asks_for_its_reset():
    registers = NodeRegisters(read(registers="csr"))
    csr = registers.csr

    async def bench(ctx):
        found = []
        ctx.set(csr.addr, 4)
        for written in (2, 4, 0, 0, 0):
            ctx.set(csr.w_data, written)
            ctx.set(csr.w_stb, written > 0)
            await ctx.tick()
            found.append(ctx.get(registers.soft_reset))
        assert found == [0, 0, 0, 1, 0]

    simulator = Simulator(registers)
    simulator.add_clock(1e-6)
    simulator.add_testbench(bench)
    simulator.run()
