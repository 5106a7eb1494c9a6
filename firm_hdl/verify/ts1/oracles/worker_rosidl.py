"""The readers of ROS 2 for `worker_script`, for any release of rosidl.

rosidl_adapter converts ``.msg``, ``.srv`` and ``.action`` to IDL, and rosidl_parser reads IDL. From
iron on, rosidl_generator_type_description computes the type hashes.
"""

import ast
import functools
import os
import re

__all__ = ["readers"]


def readers(folder):
    """Load ROS 2's modules; return the functions that answer requests, and the modules' names."""
    import rosidl_adapter.parser
    import rosidl_adapter.resource
    import rosidl_parser.parser

    reader = _Rosidl(rosidl_adapter, rosidl_parser, folder)
    try:
        import rosidl_generator_type_description
    except ImportError:
        pass  # Humble has no type hashes.
    else:
        reader.hashes = _Hashes(reader, rosidl_generator_type_description)
    judges = {"rosidl_adapter": reader.adapter, "rosidl_parser": reader.parser}
    return judges, tuple(judges)


class _RefusedError(Exception):
    pass


# This script runs in ROS's own Python, without firm-hdl, whose model the answers judge.
PLACEHOLDER = "structure_needs_at_least_one_member", "uint8"


class _Rosidl:
    def __init__(self, rosidl_adapter, rosidl_parser, folder):
        self.reader = rosidl_adapter.parser
        self.evaluate = rosidl_adapter.resource.evaluate_template
        self.parse_idl = functools.lru_cache(maxsize=64)(rosidl_parser.parser.parse_idl_string)
        self.folder = folder
        self.hashes = None
        self.known = {}  # Message types in files: None, or why the type cannot be used.
        self.convert = functools.lru_cache(maxsize=512)(self._convert)

    def adapter(self, request):
        specs, _ = self._read(request)
        self._check_needs(request, _needs(*specs.values()))
        return {"structure": {name: _adapter_message(spec) for name, spec in specs.items()}}

    def parser(self, request):
        content = self.content(request)
        # rosidl_adapter changes comments, so of its IDL they are not those of the definition.
        remarks = _idl_remarks if request["file"].endswith(".idl") else _no_remarks
        parsed = _parsed(content, request["has_events"], remarks)
        facts = {"structure": self._without_placeholders(parsed, request)}
        # A type whose bound is the name of a constant has no hash, because a number is missing.
        is_numbered = not _has_named_bounds(facts["structure"])
        if self.hashes is not None and request["has_events"] and is_numbered:
            facts["hash"] = self.hashes.of(content, request)
        if request["file"].endswith(".idl"):
            _name_by_file(facts, request)
        return facts

    def _without_placeholders(self, messages, request):
        """Leave out the member that rosidl_adapter gives to messages without fields."""
        if request["file"].endswith(".idl"):
            empty = [
                name
                for name, each in messages.items()
                if [(one["name"], one["type"]) for one in each["fields"]] == [PLACEHOLDER]
            ]
        else:
            empty = [name for name, spec in self._read(request)[0].items() if not spec.fields]
        return {
            name: {**each, "fields": []} if name in empty else each
            for name, each in messages.items()
        }

    def content(self, request):
        """Read a definition, and check the types that it needs; return rosidl_parser's object."""
        if request["file"].endswith(".idl"):
            content = self.parse_idl(self.text(request))
            self._check_needs(request, _idl_needs(_parsed(content)))
        else:
            specs, idl = self._read(request)
            content = self.parse_idl(idl)
            self._check_needs(request, _needs(*specs.values()))
        return content

    def _read(self, request):
        key = request["package"], request["kind"], request["name"], self.text(request)
        return self.convert(*key)

    def text(self, request):
        path = os.path.join(self.folder, request["package"], request["kind"], request["file"])
        with open(path, encoding="utf-8") as lines:
            return lines.read()

    def _convert(self, package, kind, name, text):
        """Read a text; return its messages by name, and the IDL that rosidl_adapter writes."""
        if kind == "msg":
            whole = self.reader.parse_message_string(package, name, text)
            parts = {f"{package}/msg/{name}": whole}
        elif kind == "srv":
            whole = self.reader.parse_service_string(package, name, text)
            parts = {f"_{each}": getattr(whole, each.lower()) for each in ("Request", "Response")}
        else:
            whole = self.reader.parse_action_string(package, name, text)
            ends = "Goal", "Result", "Feedback"
            parts = {f"_{each}": getattr(whole, each.lower()) for each in ends}
        parts = {
            (f"{package}/{kind}/{name}{end}" if end[0] == "_" else end): part
            for end, part in parts.items()
        }
        data = {"pkg_name": package, "relative_input_file": f"{kind}/{name}.{kind}", kind: whole}
        idl = self.evaluate(f"{kind}.idl.em", data)
        # rosidl writes IDL in one encoding and reads it in another, which restores its literals.
        return parts, idl.encode("iso-8859-1").decode("utf-8")

    def _check_needs(self, request, needs):
        """Refuse a definition if a type that it needs is missing or refused, as a build would."""
        own = f"{request['package']}/msg/{request['name']}"
        path = {own} if request["kind"] == "msg" else set()
        for need in needs:
            why = self._state(need, path)
            if why is not None:
                raise _RefusedError(why)

    def _state(self, name, path):
        if name in path:
            return f"{name} contains itself"
        if name not in self.known:
            path.add(name)
            self.known[name] = self._find_state(name, path)
            path.discard(name)
        return self.known[name]

    def _find_state(self, name, path):
        package, _, base = name.split("/")
        for end in (".msg", ".idl"):
            request = {"package": package, "kind": "msg", "file": base + end}
            try:
                text = self.text(request)
            except OSError:
                continue
            except ValueError as error:
                return f"{name}: {error}"
            try:
                if end == ".idl":
                    needs = _idl_needs(_parsed(self.parse_idl(text)))
                else:
                    needs = _needs(self.convert(package, "msg", base, text)[0][name])
            except Exception as error:
                return f"{name}: {type(error).__name__}: {error}"
            for need in needs:
                why = self._state(need, path)
                if why is not None:
                    return why
            return None
        return f"{name} is not there"


def _idl_needs(messages):
    types = [field["type"] for message in messages.values() for field in message["fields"]]
    # Types in other folders are messages of services and actions, which have no files.
    return [name for name in (each.partition("[")[0] for each in types) if "/msg/" in name]


def _needs(*specs):
    types = [field.type for spec in specs for field in spec.fields]
    return [f"{each.pkg_name}/msg/{each.type}" for each in types if not each.is_primitive_type()]


def _adapter_message(spec):
    fields = []
    for field in spec.fields:
        entry = {"name": field.name, "type": _adapter_type(field.type), **_remarks(field)}
        fields.append({**entry, "default": field.default_value})
    constants = [
        {"name": each.name, "type": each.type, "value": each.value, **_remarks(each)}
        for each in spec.constants
    ]
    comment = "\n".join(spec.annotations.get("comment", []))
    return {"fields": fields, "constants": constants, "comment": comment}


def _remarks(element):
    return {
        "comment": "\n".join(element.annotations.get("comment", [])),
        "unit": element.annotations.get("unit"),
    }


def _adapter_type(kind):
    name = kind.type if kind.is_primitive_type() else f"{kind.pkg_name}/msg/{kind.type}"
    if kind.string_upper_bound is not None:
        name += f"<={kind.string_upper_bound}"
    if not kind.is_array:
        return name
    at_most = "<=" if kind.is_upper_bound else ""
    return f"{name}[{at_most}{'' if kind.array_size is None else kind.array_size}]"


IDL_NAMES = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}


def _element(content):
    """Return the message, the service or the action that a file declares."""
    (element,) = [each for each in content.elements if not hasattr(each, "locator")]
    return element


def _no_remarks(annotated):
    return {}


def _idl_remarks(annotated):
    """Return the comment and the unit of a member or of a constant, as far as they are texts."""
    units = [each for each in annotated.get_annotation_values("unit") if isinstance(each, dict)]
    unit = units[0].get("value") if units else None
    found = {"unit": unit} if unit is None or isinstance(unit, str) else {}
    try:
        return {**found, "comment": "\n".join(annotated.get_comment_lines())}
    except (AttributeError, TypeError):
        # rosidl_parser reads a ``@verbatim`` without texts, and fails at the question.
        return found


def _parsed(content, has_events=False, remarks=_no_remarks):
    """Describe rosidl_parser's reading of a file; `remarks` returns more about a member."""
    element = _element(content)
    messages = []
    if hasattr(element, "structure"):
        messages = [element]
    elif hasattr(element, "request_message"):
        messages = _messages_of_service(element, has_events)
    else:
        messages = [element.goal, element.result, element.feedback]
        for service in (element.send_goal_service, element.get_result_service):
            messages += _messages_of_service(service, has_events)
        messages.append(element.feedback_message)
    found = {_type(m.structure.namespaced_type): _parsed_message(m, remarks) for m in messages}
    if hasattr(element, "structure") and "comment" in (said := remarks(element.structure)):
        # Parts of services and actions have no comments in rosidl_parser.
        found[_type(element.structure.namespaced_type)]["comment"] = said["comment"]
    return found


def _name_by_file(facts, request):
    """Name messages by package and folder; the modules around them in the text are ``scope``."""
    messages = facts["structure"]
    scopes = {name.rpartition("/")[0] for name in messages}
    if len(scopes) != 1:
        return
    (scope,) = scopes

    def named(kind):
        own = f"{request['package']}/{request['kind']}/{kind[len(scope) :].lstrip('/')}"
        return own if kind.partition("[")[0] in messages else kind

    facts["scope"] = scope
    facts["structure"] = {
        named(name): {
            **message,
            "fields": [{**each, "type": named(each["type"])} for each in message["fields"]],
        }
        for name, message in messages.items()
    }


def _has_named_bounds(messages):
    types = [field["type"] for message in messages.values() for field in message["fields"]]
    return any(re.search(r"<=(?!\d)", each) for each in types)


def _messages_of_service(service, has_events):
    # rosidl has event messages from iron on.
    events = [service.event_message] if has_events and hasattr(service, "event_message") else []
    return [service.request_message, service.response_message, *events]


def _parsed_message(message, remarks=_no_remarks):
    members = [
        {"name": each.name, "type": _type(each.type), "default": _default(each), **remarks(each)}
        for each in message.structure.members
    ]
    constants = []
    for each in message.constants:
        kind = type(each.type).__name__
        # The type of a string constant has its own length as a bound.
        name = {"BoundedString": "string", "BoundedWString": "wstring"}.get(kind)
        kind = name or _type(each.type)
        constants.append({"name": each.name, "type": kind, "value": each.value, **remarks(each)})
    return {"fields": members, "constants": constants}


def _type(kind):
    form = type(kind).__name__
    if form == "BasicType":
        return IDL_NAMES.get(kind.typename, kind.typename)
    if form == "NamespacedType":
        return "/".join([*kind.namespaces, kind.name])
    if form in ("UnboundedString", "UnboundedWString"):
        return form.removeprefix("Unbounded").lower()
    if form in ("BoundedString", "BoundedWString"):
        return f"{form.removeprefix('Bounded').lower()}<={kind.maximum_size}"
    if form == "Array":
        return f"{_type(kind.value_type)}[{kind.size}]"
    if form == "BoundedSequence":
        return f"{_type(kind.value_type)}[<={kind.maximum_size}]"
    if form == "UnboundedSequence":
        return f"{_type(kind.value_type)}[]"
    raise _RefusedError(f"{form} has no name in ROS")


def _default(member):
    if not member.has_annotation("default"):
        return None
    value = member.get_annotation_value("default")["value"]
    # Lists are texts in Python's syntax, which generators evaluate.
    is_list = type(member.type).__name__ in ("Array", "BoundedSequence", "UnboundedSequence")
    if not is_list or not isinstance(value, str):
        return value
    items = ast.literal_eval(value)
    return list(items) if isinstance(items, (list, tuple)) else value


class _Hashes:
    """Computes type hashes of what rosidl_parser reads, with rosidl's own functions.

    ``generate_type_hash`` itself takes a whole package, and reads other packages from the files of
    their builds. This class takes the same steps for single definitions.
    """

    def __init__(self, reader, describing):
        self.reader, self.describing = reader, describing
        self.needed = {}  # Individual descriptions of types in files, by name.

    def of(self, content, request):
        """Return the hash of a message, a service or an action, and those of its messages.

        If rosidl raises an error, return the error as text. Such a type cannot be built.
        """
        try:
            return self._of(_element(content), request)
        except (KeyError, ValueError) as error:
            return f"raises {type(error).__name__}: {error}"

    def _of(self, element, request):
        own = self._individual(element, request)
        self.needed.update(own)
        described = {**self.needed, **own}
        pending = list(own)
        seen = set(own)
        while pending:
            for need in _referred(described[pending.pop()]) - seen:
                seen.add(need)
                if need not in described:
                    described[need] = self.needed[need] = self._described(need)
                pending.append(need)
        return {name: self._hash(name, described) for name in own}

    def _individual(self, element, request):
        """Describe each type that a file declares.

        Types are named by their file, even if the modules of an IDL have other names.
        """
        add = self.describing
        found = {}
        if hasattr(element, "structure"):
            top = element.structure.namespaced_type
            add.add_msg(element, found)
        else:
            top = element.namespaced_type
            adder = add.add_srv if hasattr(element, "request_message") else add.add_action
            adder(element, found)
        full_name = "/".join(top.namespaced_name())
        own = f"{request['package']}/{request['kind']}/{request['name']}"

        def named(name):
            return own + name[len(full_name) :] if name in found else name

        described = {}
        for name, each in found.items():
            entry = add.serialize_individual_type_description(each.namespaced_type, each.members)
            for field in entry["fields"]:
                field["type"]["nested_type_name"] = named(field["type"]["nested_type_name"])
            described[named(name)] = {**entry, "type_name": named(name)}
        return described

    def _described(self, name):
        package, kind, base = name.split("/")
        for end in (".msg", ".idl"):
            request = {"package": package, "kind": kind, "name": base, "file": base + end}
            try:
                element = _element(self.reader.content(request))
            except OSError:
                continue
            return self._individual(element, request)[name]
        raise ValueError(f"{name} is not there")

    def _hash(self, name, described):
        # rosidl extracts only the types that are needed, and fails if one of them is missing.
        return self.describing.calculate_type_hash(
            self.describing.extract_full_type_description(name, described)
        )


def _referred(description):
    names = {field["type"]["nested_type_name"] for field in description["fields"]}
    return names - {""}
