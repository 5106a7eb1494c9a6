"""Ask Debian's rosmsg for examples of messages; run by the Python that has it, without firm-hdl.

Arguments: folders with packages. Each line of standard
input names a type; each line of standard output is the JSON text of what ``rosmsg-proto`` prints
for it, or ``null`` if the tool fails. Classes are made by genpy on the fly, as rosmsg would find
them only in built packages.
"""

import json
import sys
from pathlib import Path

import genmsg
import genpy.dynamic
import roslib.message
import rosmsg


def main(folders):
    search_path = {}
    for folder in folders:
        for package in Path(folder).glob("*/msg"):
            search_path.setdefault(package.parent.name, []).append(str(package))
    classes = {}

    def get_message_class(name):
        if name not in classes:
            context = genmsg.MsgContext.create_default()
            spec = genmsg.load_msg_by_type(context, name, search_path)
            genmsg.load_depends(context, spec, search_path)
            text = genmsg.gentools.compute_full_text(context, spec)
            generated = genpy.dynamic.generate_dynamic(name, text)
            classes[name] = generated[name]
        return classes[name]

    roslib.message.get_message_class = get_message_class
    for line in sys.stdin:
        try:
            text = rosmsg.rosmsg_cmd_prototype(["msg", line.strip()])
        except Exception as error:
            print(repr(error), file=sys.stderr)
            text = None
        print(json.dumps(text), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
