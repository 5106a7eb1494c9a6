"""Run the test benches of geometry_msgs/msg/Twist (lyrical, cdr, bus of 8 bytes) with VUnit 4 (pip install vunit_hdl)."""


from pathlib import Path

from vunit import VUnit

HERE = Path(__file__).resolve().parent
FILES = [
    "firm_hdl_types_pkg.vhd",
    "firm_hdl_pkg.vhd",
    "firm_hdl_bus_8_pkg.vhd",
    "geometry_msgs_msg_vector3_cdr_8_pkg.vhd",
    "geometry_msgs_msg_twist_cdr_8_pkg.vhd",
    "geometry_msgs_msg_twist_cdr_8_components_pkg.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_marks.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat_core.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_flat.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_flat_core_collector.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_flat_core.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_flat.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_buffer.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer_marks.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_queue.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_mover.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_collector.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_packer.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_record_flat_record.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_record_flat.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer.vhd",
    "geometry_msgs_msg_twist_cdr_8_deserializer_record.vhd",
    "geometry_msgs_msg_twist_cdr_8_serializer_record.vhd",
    "firm_hdl_bench_pkg.vhd",
    "firm_hdl_axis_source.vhd",
    "firm_hdl_axis_sink.vhd",
    "geometry_msgs_msg_twist_cdr_8_tb.vhd",
    "geometry_msgs_msg_twist_cdr_8_record_tb.vhd",
    "tb_geometry_msgs_msg_twist_cdr_8_vunit.vhd",
]

vunit = VUnit.from_argv(compile_builtins=False)
vunit.add_vhdl_builtins()
library = vunit.add_library("firm_hdl")
for file in FILES:
    library.add_source_file(HERE / file, vhdl_standard="2008")
bench = library.test_bench("tb_geometry_msgs_msg_twist_cdr_8_vunit")
bench.set_sim_option("ghdl.sim_flags", ["--ieee-asserts=disable-at-0"])
for stalls in (0, 40):
    bench.add_config(f"stalls_{stalls}", generics={"stalls": stalls, "folder": f"{HERE}/"})
vunit.main()
