"""The message model: what a ROS interface definition means, with every name resolved.

A model is a tree of frozen values, equal when the definitions mean the same. It has the size of
each primitive; everything else about bytes on a wire is in :mod:`firm_hdl.wire`. Analyses are
attributes that are computed when first read and then cached, as in a reference attribute grammar:
each attribute is an equation over the node and its children.
"""

from firm_hdl.model.message import (
    Action,
    Constant,
    Field,
    Interface,
    Message,
    Service,
    closure,
    is_fixed_size,
    map_messages,
)
from firm_hdl.model.types import (
    EMPTY_MEMBER,
    IDL_PRIMITIVES,
    PRIMITIVE_OF,
    PRIMITIVES,
    WIRE_OF,
    Array,
    Dialect,
    FieldType,
    Primitive,
    Sequence,
    String,
    Value,
    Wire,
    element_of,
    idl_primitives,
    type_text,
)

__all__ = [
    "EMPTY_MEMBER",
    "IDL_PRIMITIVES",
    "PRIMITIVES",
    "PRIMITIVE_OF",
    "WIRE_OF",
    "Action",
    "Array",
    "Constant",
    "Dialect",
    "Field",
    "FieldType",
    "Interface",
    "Message",
    "Primitive",
    "Sequence",
    "Service",
    "String",
    "Value",
    "Wire",
    "closure",
    "element_of",
    "idl_primitives",
    "is_fixed_size",
    "map_messages",
    "type_text",
]
