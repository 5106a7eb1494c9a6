"""The readers of ROS 1 for `worker_script`: genmsg, and rosmsg on top of it."""

import functools
import os

__all__ = ["readers"]


def readers(folder):
    """Load ROS 1's modules; return the functions that answer requests, and the modules' names."""
    import genmsg
    import genmsg.gentools

    try:
        from rosmsg import spec_to_str
    except ImportError:
        spec_to_str = None
    reader = _Genmsg(genmsg, spec_to_str, folder)
    return {"genmsg": reader.judge}, ("genmsg", "rosmsg")


class _Genmsg:
    def __init__(self, genmsg, spec_to_str, folder):
        self.genmsg = genmsg
        self.spec_to_str = spec_to_str
        self.folder = folder

    @functools.cached_property
    def paths(self):
        return {name: [os.path.join(self.folder, name, "msg")] for name in os.listdir(self.folder)}

    def judge(self, request):
        full_name = f"{request['package']}/{request['name']}"
        file = os.path.join(self.folder, request["package"], request["kind"], request["file"])
        return getattr(self, "_" + request["kind"])(full_name, file)

    def _msg(self, full_name, file):
        context = self.genmsg.MsgContext.create_default()
        spec = self.genmsg.msg_loader.load_msg_from_file(context, file, full_name)
        self.genmsg.load_depends(context, spec, self.paths)
        return self._facts(context, spec, [spec])

    def _srv(self, full_name, file):
        context = self.genmsg.MsgContext.create_default()
        spec = self.genmsg.msg_loader.load_srv_from_file(context, file, full_name)
        self.genmsg.load_depends(context, spec, self.paths)
        return self._facts(context, spec, [spec.request, spec.response])

    def _action(self, full_name, file):
        package, _, name = full_name.partition("/")
        with open(file) as lines:
            texts = _action_messages(name, lines.read())
        context = self.genmsg.MsgContext.create_default()
        specs = [
            self.genmsg.msg_loader.load_msg_from_string(context, text, f"{package}/{name}")
            for name, text in texts.items()
        ]
        for spec in specs:
            self.genmsg.load_depends(context, spec, self.paths)
        facts = {"structure": {}, "md5": {}}
        for spec in specs:
            for key, value in self._facts(context, spec, [spec]).items():
                facts.setdefault(key, {}).update(value if key != "show" else {})
        del facts["show"]
        return facts

    def _facts(self, context, spec, messages):
        facts = {
            "structure": {message.full_name: _genmsg_message(message) for message in messages},
            "md5": {spec.full_name: self.genmsg.gentools.compute_md5(context, spec)},
        }
        if self.spec_to_str is not None:
            facts["show"] = "---\n".join(self.spec_to_str(context, each) for each in messages)
        return facts


def _genmsg_message(spec):
    fields = []
    for field in spec.parsed_fields():
        size = "" if field.array_len is None else field.array_len
        fields.append(
            {"name": field.name, "type": field.base_type + (f"[{size}]" if field.is_array else "")}
        )
    constants = [
        {"name": each.name, "type": each.type, "value": each.val, "text": each.val_text}
        for each in spec.constants
    ]
    return {"fields": fields, "constants": constants}


def _action_messages(name, text):
    """Expand a ROS 1 action by the rule of actionlib's genaction, which Debian does not have."""
    pieces = [[]]
    for line in text.split("\n"):
        if line.startswith("---"):
            pieces.append([])
        else:
            pieces[-1].append(line + "\n")
    if len(pieces) != 3:
        raise ValueError(f"an action has 3 parts, not {len(pieces)}")
    goal, result, feedback = ("".join(piece) for piece in pieces)
    header = "Header header\n"
    return {
        f"{name}Goal": goal,
        f"{name}Result": result,
        f"{name}Feedback": feedback,
        f"{name}ActionGoal": f"{header}actionlib_msgs/GoalID goal_id\n{name}Goal goal\n",
        f"{name}ActionResult": f"{header}actionlib_msgs/GoalStatus status\n{name}Result result\n",
        f"{name}ActionFeedback": (
            f"{header}actionlib_msgs/GoalStatus status\n{name}Feedback feedback\n"
        ),
        f"{name}Action": (
            f"{name}ActionGoal action_goal\n"
            f"{name}ActionResult action_result\n"
            f"{name}ActionFeedback action_feedback\n"
        ),
    }
