"""Documents about a type's converters: the plan as YAML, and a picture of the layout."""

from __future__ import annotations

from firm_hdl.export.backend import BackEnd, Converters, Output
from firm_hdl.plan import to_yaml
from firm_hdl.wire import lay_out
from firm_hdl.wire.picture import to_svg

__all__ = ["Documents"]


class Documents(BackEnd):
    """`plan.yaml` and `layout.svg`."""

    name = "documents"

    def write(self, converters: Converters) -> Output:
        message, plan = converters.message, converters.plan
        picture = to_svg(lay_out(message, plan.wire), f"{message.name} on {plan.wire}")
        return Output(files={"plan.yaml": to_yaml(plan), "layout.svg": picture})
