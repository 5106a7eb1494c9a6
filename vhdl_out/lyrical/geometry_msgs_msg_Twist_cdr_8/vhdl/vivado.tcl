# Read the converters of geometry_msgs/msg/Twist (lyrical, cdr, bus of 8 bytes) into Vivado:
#
#   source .../vivado.tcl
#
# The files are read in compile order, as VHDL-2008, into the current library. Test benches are left
# out.

set firm_hdl_folder [file dirname [file normalize [info script]]]

# Every type that needs one of these files has it, with the same text: read each file once.
foreach firm_hdl_file {
  firm_hdl_types_pkg.vhd
  firm_hdl_pkg.vhd
  firm_hdl_bus_8_pkg.vhd
  geometry_msgs_msg_vector3_cdr_8_pkg.vhd
  geometry_msgs_msg_twist_cdr_8_pkg.vhd
} {
  if {[llength [get_files -quiet "*/$firm_hdl_file"]] == 0} {
    read_vhdl -vhdl2008 [file join $firm_hdl_folder $firm_hdl_file]
  }
}

foreach firm_hdl_file {
  geometry_msgs_msg_twist_cdr_8_components_pkg.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_buffer.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer_marks.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_sequencer.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_queue.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat_core_mover.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat_core.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_flat.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_flat_core_collector.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_flat_core_packer.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_flat_core.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_flat.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_buffer.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer_marks.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_sequencer.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_queue.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core_mover.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_core.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat_record.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_collector.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core_packer.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_record_flat_core.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_record_flat_record.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_record_flat.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer.vhd
  geometry_msgs_msg_twist_cdr_8_serializer.vhd
  geometry_msgs_msg_twist_cdr_8_deserializer_record.vhd
  geometry_msgs_msg_twist_cdr_8_serializer_record.vhd
} {
  read_vhdl -vhdl2008 [file join $firm_hdl_folder $firm_hdl_file]
}
