"""Which signals and words of memories of both sides are the same: by names, module by module."""

from __future__ import annotations

from dataclasses import dataclass, field

from firm_hdl.equivalence.match import Match, match_names

RTLIL = r"""
module \top
  memory width 4 size 3 \words
  wire width 4 \Q
  cell \part \first
    connect \a \Q
  end
  cell \part \second
  end
  cell \foreign \odd
  end
  cell $dff $1
  end
end
module \part
  wire width 1 \r
  cell \inner \below
  end
end
module \inner
  memory width 8 size 2 \words
end
module \foreign
  wire width 1 \r
end
"""


@dataclass(frozen=True)
class Names:
    """The names of one module in VHDL."""

    signals: dict[str, str] = field(default_factory=dict)
    memories: dict[str, str] = field(default_factory=dict)
    instances: dict[str, str] = field(default_factory=dict)


TOP = Names(
    signals={"Q": "Q_2"},
    memories={"words": "Store_mem"},
    # An instance without a label is not in the VHDL.
    instances={"first": "First", "second": "second_2"},
)
ENTITIES = {
    "top": TOP,
    "part": Names(signals={"r": "r_reg"}, instances={"below": "Below"}),
    "inner": Names(memories={"words": "words", "gone": "gone"}),
    "foreign": Names(signals={"r": "r"}),
}


def test_paths_follow_the_instances_of_both_sides():
    words = {
        (*rtlil, "below", f"words[{place}]"): (*vhdl, "below", f"words[{place}]")
        for rtlil, vhdl in ((("first",), ("first",)), (("second",), ("second_2",)))
        for place in range(2)
    }
    assert match_names(RTLIL, "top", ENTITIES) == Match(
        # Names in VHDL are in lower case.
        signals={
            ("Q",): ("q_2",),
            **{(f"words[{place}]",): (f"store_mem[{place}]",) for place in range(3)},
            ("first", "r"): ("first", "r_reg"),
            ("second", "r"): ("second_2", "r_reg"),
            **words,
        },
        memories={
            ("store_mem",): 3,
            ("first", "below", "words"): 2,
            ("second_2", "below", "words"): 2,
            # A memory without bits is not in the RTLIL.
            ("first", "below", "gone"): 0,
            ("second_2", "below", "gone"): 0,
        },
    )


def test_a_module_without_names_has_no_signals():
    entities = {name: names for name, names in ENTITIES.items() if name != "part"}
    assert ("first", "r") not in match_names(RTLIL, "top", entities).signals
    assert match_names(RTLIL, "inner", ENTITIES).memories == {("words",): 2, ("gone",): 0}
    assert match_names(RTLIL, "nothing", ENTITIES) == Match(signals={}, memories={})
