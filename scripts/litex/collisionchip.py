# SPDX-License-Identifier: Apache-2.0
"""cchip_chip as a LiteX core: one slot with the quad test, nothing is exchanged at run time.

    self.chip = CollisionChip(platform)
    self.chip.add_to(self, origin=0x9000_0000)

Registers: docs/hardware/chip-registers.md; how a driver uses them: docs/hardware/programmers-guide.md. The memory that
`memory` reaches has to be coherent with the CPU's view of it."""
import pathlib

from litex.gen import LiteXModule
from litex.soc.integration.soc import SoCRegion
from litex.soc.interconnect.axi import AXIInterface, AXILiteInterface
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourceLevel
from migen import ClockSignal, Constant, Instance, ResetSignal, Signal

RTL = pathlib.Path(__file__).resolve().parents[2] / "rtl"


class CollisionChip(LiteXModule):
    """bus: registers, 4 KiB on AXI4-Lite. memory: AXI4 master for images, queries and records. ev: the interrupt.
    file_list: rtl/cchip.f, or rtl/cchip_DEVICE.f with the leaves of a device. parameters: of cchip_chip, as
    QUERIES=8."""

    def __init__(self, platform, file_list="cchip.f", **parameters):
        data_width = parameters.get("DATA_W", 128)
        id_width = (parameters.get("MISSES", 32) - 1).bit_length() + 1
        self.bus = bus = AXILiteInterface(data_width=32, address_width=32)
        self.memory = memory = AXIInterface(data_width=data_width, address_width=64, id_width=id_width)
        self.ev = EventManager()
        self.ev.chip = EventSourceLevel(description="Interrupt of the chip: see its interrupt_status.")
        self.ev.finalize()

        ports = {"i_clk": ClockSignal("sys"), "i_rst": ResetSignal("sys"), "o_irq": self.ev.chip.trigger}
        for name, channel, fields, outputs in (
                ("s_axil_aw", bus.aw, ("addr", "prot"), False), ("s_axil_w", bus.w, ("data", "strb"), False),
                ("s_axil_b", bus.b, ("resp",), True), ("s_axil_ar", bus.ar, ("addr", "prot"), False),
                # no error: on a wide bus that of a word that is no register would stand for the whole line
                ("s_axil_r", bus.r, ("data",), True),
                ("m_axi_ar", memory.ar, ("id", "addr", "len", "size", "burst", "cache", "prot"), True),
                ("m_axi_r", memory.r, ("id", "data", "resp", "last"), False),
                ("m_axi_aw", memory.aw, ("addr", "len", "size", "burst", "cache", "prot"), True),
                ("m_axi_w", memory.w, ("data", "strb", "last"), True), ("m_axi_b", memory.b, ("resp",), False)):
            forward, back = ("o", "i") if outputs else ("i", "o")
            ports[f"{forward}_{name}valid"] = channel.valid
            ports[f"{back}_{name}ready"] = channel.ready
            for field in fields:
                ports[f"{forward}_{name}{field}"] = getattr(channel, field)
        # The registers are ready before a request comes, as AXI allows. LiteX's converter from a wider bus counts that
        # as taken for a word that it does not even offer, then awaits its response for ever. So ready rises after
        # valid; a register between them, because LiteX's Verilog makes Icarus loop on a path from valid to ready.
        for name, channel in (("aw", bus.aw), ("w", bus.w)):
            offered, ready = Signal(name=f"chip_{name}offered"), Signal(name=f"chip_{name}ready")
            ports[f"i_s_axil_{name}valid"], ports[f"o_s_axil_{name}ready"] = channel.valid & offered, ready
            self.comb += channel.ready.eq(ready & offered)
            self.sync += offered.eq(channel.valid & ~channel.ready)
        for name, channel in (("aw", bus.aw), ("ar", bus.ar)):
            ports[f"i_s_axil_{name}addr"] = channel.addr[:12]
        ports["i_m_axi_bid"] = 0  # m_axi_awid is 0, as memory.aw.id is
        for name, width in (("cfg_error", 1), ("m_axi_cfg_arready", 1), ("m_axi_cfg_rvalid", 1),
                            ("m_axi_cfg_rdata", 32),
                            ("m_axi_cfg_rresp", 2), ("m_axi_cfg_rlast", 1)):
            ports[f"i_{name}"] = Constant(0, width)
        # to LiteX an address is a packet of one beat
        self.comb += [channel.last.eq(1) for channel in (memory.ar, memory.aw)]
        self.specials += Instance("cchip_chip", **{f"p_{name}": value for name, value in parameters.items()}, **ports)
        self.add_sources(platform, file_list)

    def add_to(self, soc, origin, name="chip"):
        """Connects registers, memory and, if the SoC has a CPU, the interrupt; `name`: this core's attribute of the
        SoC. A bus whose addresses are narrower cuts off the upper bits of the chip's. ValueError: a bus on which
        records would arrive in parts."""
        if soc.bus.data_width < 128:
            raise ValueError(f"{name}: the SoC's bus ({soc.bus.standard}) has {soc.bus.data_width} bit, and the chip's "
                             "records of 128 bit would "
                             "arrive in parts; build the SoC with bus_data_width=128")
        soc.bus.add_slave(name, self.bus, SoCRegion(origin=origin, size=0x1000, cached=False))
        memory = self.memory
        if memory.address_width != soc.bus.address_width:  # LiteX's bridges want both alike
            memory = AXIInterface(data_width=memory.data_width, address_width=soc.bus.address_width,
                                  id_width=memory.id_width)
            self.comb += self.memory.connect(memory)
        soc.bus.add_master(name, memory)
        if soc.irq.enabled:
            soc.irq.add(name, use_loc_if_exists=True)

    @staticmethod
    def add_sources(platform, file_list="cchip.f"):
        """The RTL of the whole chip and its include folder."""
        platform.add_verilog_include_path(str(RTL / "include"))
        for line in (RTL / file_list).read_text().splitlines():
            if line.strip().endswith(".v"):
                platform.add_source(str(RTL / line.strip()))
