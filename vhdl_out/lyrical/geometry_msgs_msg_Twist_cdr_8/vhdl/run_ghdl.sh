#!/bin/sh
# Run the test bench in GHDL. Arguments go to the simulation, such as -gseed=7 or --wave=tb.ghw.
# Files of GHDL and of the bench are written to work/ beside this script. Environment variables:
# WORK names another folder, GHDL the command of GHDL, and BENCH another bench of this folder.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
work=${WORK:-$here/work}
ghdl=${GHDL:-}
if [ -z "$ghdl" ]; then
  for name in ghdl ghdl-mcode ghdl-llvm ghdl-gcc; do
    if command -v "$name" >/dev/null 2>&1; then ghdl=$name; break; fi
  done
fi
if [ -z "$ghdl" ]; then
  echo "run_ghdl.sh: GHDL is not installed (Debian, Ubuntu: apt install ghdl)" >&2
  exit 127
fi
if [ ! -f "$here/stimuli.txt" ]; then
  echo "run_ghdl.sh: write packets to $here/stimuli.txt, one per line, in hexadecimal" >&2
  exit 2
fi
# A waveform is written where the user is, in the format of its name: .ghw, .vcd or .fst.
for argument; do
  shift
  case $argument in
    --wave=*.vcd) argument=--vcd=${argument#*=} ;;
    --wave=*.fst) argument=--fst=${argument#*=} ;;
  esac
  case $argument in
    --wave=/* | --vcd=/* | --fst=/*) ;;
    --wave=* | --vcd=* | --fst=*) argument=${argument%%=*}=$PWD/${argument#*=} ;;
  esac
  set -- "$@" "$argument"
done
mkdir -p "$work"
cd "$work"
printf '*\n' > .gitignore
# GHDL gets relative names only: it does not accept a folder whose name has a quotation mark.
from=..
if [ -n "${WORK:-}" ]; then
  from=source
  rm -f "$from"
  ln -s "$here" "$from"
fi
"$ghdl" -a --std=08 \
  "$from/firm_hdl_types_pkg.vhd" \
  "$from/firm_hdl_pkg.vhd" \
  "$from/firm_hdl_bus_8_pkg.vhd" \
  "$from/geometry_msgs_msg_vector3_cdr_8_pkg.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_pkg.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_components_pkg.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_deserializer_flat.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_serializer_flat.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_deserializer_record_flat.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_serializer_record_flat.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_deserializer.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_serializer.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_deserializer_record.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_serializer_record.vhd" \
  "$from/firm_hdl_bench_pkg.vhd" \
  "$from/firm_hdl_axis_source.vhd" \
  "$from/firm_hdl_axis_sink.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_tb.vhd" \
  "$from/geometry_msgs_msg_twist_cdr_8_record_tb.vhd"
exec "$ghdl" --elab-run --std=08 "${BENCH:-geometry_msgs_msg_twist_cdr_8_tb}" --ieee-asserts=disable-at-0 \
  -gstimuli="$from/stimuli.txt" -gexpected="$from/stimuli.txt" "$@"
