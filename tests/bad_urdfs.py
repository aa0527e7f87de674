"""Wrong and hostile URDF files with every fault that they must be refused with."""

from bad_specs import Bad

MASS = '<mass value="2"/>'
INERTIA = '<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
BASE = f"""<?xml version="1.0"?>
<robot name="test">
  <link name="base"/>
  <link name="arm">
    <inertial>
      <origin xyz="0 0 0.1" rpy="0 0 0"/>
      {MASS}
      {INERTIA}
    </inertial>
  </link>
  <joint name="hinge" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <origin xyz="0 0 1"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
    <dynamics damping="0.1"/>
  </joint>
</robot>
"""
HAND = f"""  <link name="hand"><inertial>{MASS}{INERTIA}</inertial></link>
  <joint name="wrist" type="continuous"><parent link="arm"/><child link="hand"/></joint>
"""


def chain(links, name):
    """A robot of so many links in a row."""
    one = '<link name="{1}"><inertial>{2}{3}</inertial></link><joint name="{1}" type="floating">'
    one += '<parent link="{0}"/><child link="{1}"/><origin xyz="1 2 3" rpy="1 2 3"/></joint>'
    names = ["base", *(f"{name}{i}" for i in range(links))]
    pairs = zip(names, names[1:], strict=False)
    parts = (one.format(before, after, MASS, INERTIA) for before, after in pairs)
    return f'<robot><link name="base"/>{"".join(parts)}</robot>'


def changed(old, new):
    """The one-armed robot with one piece replaced."""
    assert old in BASE
    return BASE.replace(old, new, 1)


def extended(text):
    """The robot with more elements at its end."""
    return changed("</robot>", text + "</robot>")


def grown(old="", new=""):
    """The robot with a hand on a wrist, one piece replaced."""
    assert old in HAND
    return extended(HAND.replace(old, new, 1))


BAD = (
    Bad("empty", "", "1:1 E701"),
    Bad("blank", " \n\n", "3:1 E701"),
    Bad("text", "hello", "1:1 E701"),
    Bad("yaml", "eom: 1\n", "1:1 E701"),
    Bad("binary", bytes(range(256)), "3:115 E701"),
    Bad("not UTF-8", BASE.replace("test", "t\u00e9st").encode("latin-1"), "2:15 E701"),
    Bad("UTF-16", BASE.encode("utf-16"), "1:1 E701"),
    Bad("NUL", changed("test", "te\0st"), "2:16 E701"),
    Bad("nine megabytes", BASE + " " * 9_000_000, "1:1 E702"),
    Bad("not closed", BASE.replace("</robot>\n", ""), "19:1 E701"),
    Bad("crossed", changed("</inertial>\n  </link>", "</link>\n  </inertial>"), "9:7 E701"),
    Bad("two roots", BASE + "<robot/>", "20:1 E701"),
    Bad("no quotes", changed('"0 1 0"', "0 1 0"), "15:15 E701"),
    Bad("attribute twice", changed('xyz="0 1 0"', 'xyz="0 1 0" xyz="1 0 0"'), "15:23 E701"),
    Bad("unknown entity", changed('"test"', '"&xxe;"'), "2:1 E701"),
    Bad("doctype", changed("<robot", "<!DOCTYPE robot>\n<robot"), "2:1 E702"),
    Bad(
        "entity bomb",
        changed("<robot", '<!DOCTYPE r [<!ENTITY a "x"><!ENTITY b "&a;&a;">]>\n<robot'),
        "2:1 E702",
    ),
    Bad(
        "external entity",
        changed("<robot", '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot'),
        "2:1 E702",
    ),
    Bad("deep", "<robot>" + "<a>" * 100_000, "1:185 E702"),
    Bad("too many", "<robot>" + "<a/>" * 120_000 + "</robot>", "1:400004 E702"),
    Bad("too many links", "<robot>" + "<link name='a'/>" * 401 + "</robot>", "1:1 E702"),
    Bad("too many values for a spec", chain(399, "a"), "1:1 E702"),
    Bad("too many bytes for a spec", chain(399, "a_link_with_a_long_name_"), "1:1 E702"),
    Bad("another root", BASE.replace("robot", "model"), "2:1 E703"),
    Bad("xacro", changed("<link", "<xacro:include/><link"), "2:1 E703"),
    Bad("misspelt inertial", BASE.replace("inertial>", "inertail>"), "5:5 E704"),
    Bad(
        "inertia in a link",
        changed("<inertial>\n      <origin", "<inertia>\n      <origin").replace(
            "</inertial>", "</inertia>"
        ),
        "5:5 E704",
    ),  # fmt: skip
    Bad("misspelt joint", BASE.replace("joint", "jiont"), "11:3 E704"),
    Bad("misspelt limits", changed("<limit", "<limits"), "16:5 E704"),
    Bad("misspelt rpy", changed("rpy", "ryp"), "6:29 E704"),
    Bad("quaternion", changed('rpy="0 0 0"', 'quat_xyzw="0 0 0 1"'), "6:29 E704"),
    Bad("misspelt damping", changed("damping", "dampin"), "17:15 E704"),
    Bad("misspelt lower", changed("lower", "lowr"), "16:12 E704"),
    Bad("seventh moment", changed('izz="0.1"', 'izz="0.1" iyx="0"'), "8:70 E704"),
    Bad("two inertials", changed("</inertial>", "</inertial><inertial/>"), "9:16 E705"),
    Bad("two axes", changed('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><axis/>'), "15:24 E705"),
    Bad("no mass", changed(MASS, ""), "5:5 E706"),
    Bad("no inertia", changed(INERTIA, ""), "5:5 E706"),
    Bad("no moment", changed(' izz="0.1"', ""), "8:7 E706"),
    Bad("no value", changed('value="2"', ""), "7:7 E706"),
    Bad("no parent", changed('<parent link="base"/>', ""), "11:3 E706"),
    Bad("no child", changed('<child link="arm"/>', ""), "11:3 E706"),
    Bad("no type", changed(' type="revolute"', ""), "11:3 E706"),
    Bad("no name", changed(' name="base"', ""), "3:3 E706"),
    Bad("empty name", changed('name="hinge"', 'name=" "'), "11:16 E706"),
    Bad("no xyz of an axis", changed('<axis xyz="0 1 0"/>', "<axis/>"), "15:5 E706"),
    Bad("mass in words", changed('value="2"', 'value="two"'), "7:20 E707"),
    Bad("mass with unit", changed('value="2"', 'value="2 kg"'), "7:20 E707"),
    Bad("mass nan", changed('value="2"', 'value="nan"'), "7:20 E707"),
    Bad("mass infinite", changed('value="2"', 'value="inf"'), "7:20 E707"),
    Bad("mass in hexadecimal", changed('value="2"', 'value="0x2"'), "7:20 E707"),
    Bad("mass in Arabic digits", changed('value="2"', 'value="\u0662"'), "7:20 E707"),
    Bad("mass beyond bounds", changed('value="2"', 'value="1e101"'), "7:20 E707"),
    Bad("mass beyond all bounds", changed('value="2"', 'value="1e9999"'), "7:20 E707"),
    Bad("a thousand digits", changed('value="2"', f'value="{"1" * 1000}"'), "7:20 E707"),
    Bad("thirty digits", changed('value="2"', f'value="0.{"1" * 30}"'), "7:20 E707"),
    Bad("decimal comma", changed("0 0 0.1", "0 0 0,1"), "6:20 E707"),
    Bad("two coordinates", changed("0 0 0.1", "0 0.1"), "6:20 E707"),
    Bad("four coordinates", changed("0 1 0", "0 1 0 0"), "15:16 E707"),
    Bad("power", changed("0 0 0.1", "0 0 2**9"), "6:20 E707"),
    Bad("property of xacro", changed("0 0 0.1", "0 0 ${h}"), "6:20 E707"),
    Bad("unknown type", changed("revolute", "revolut"), "11:29 E708"),
    Bad("spherical", changed("revolute", "ball"), "11:29 E708"),
    Bad("two links of a name", extended('<link name="arm"/>'), "19:13 E709"),
    Bad("two joints of a name", grown("wrist", "hinge"), "20:16 E709"),
    Bad("unknown parent", changed('link="base"', 'link="bass"'), "11:3 E710"),
    Bad("unknown child", changed('link="arm"', 'link="harm"'), "11:3 E710"),
    Bad("no link", "<robot/>", "1:1 E711"),
    Bad("two roots of the tree", extended('<link name="table"/>'), "19:1 E711"),
    Bad("two parents", grown('child link="hand"', 'child link="arm"'), "20:3 E711"),
    Bad("loop", changed('parent link="base"', 'parent link="arm"'), "11:3 E711"),
    Bad("all in a loop", grown('child link="hand"', 'child link="base"'), "11:3 E711"),
    Bad("axis zero", changed("0 1 0", "0 0 0"), "15:16 E712"),
    Bad("planar and skew", changed("revolute", "planar").replace("0 1 0", "0 1 1"), "15:16 E712"),
    Bad("negative mass", changed('value="2"', 'value="-2"'), "7:20 E713"),
    Bad("negative damping", changed('"0.1"/>\n  </j', '"-0.1"/>\n  </j'), "17:24 E713"),
    Bad("negative inertia", changed('ixx="0.1"', 'ixx="-0.1"'), "8:7 E504"),
    Bad("no body's inertia", changed('ixx="0.1"', 'ixx="0.3"'), "8:7 E505"),
    Bad("no body's products", changed('ixy="0"', 'ixy="0.09"'), "8:7 E505"),
    Bad("limits crossed", changed('upper="1"', 'upper="-2"'), "16:5 E714"),
    Bad("mimic of nobody", grown("</joint>", '<mimic joint="hing"/></joint>'), "20:81 E715"),
    Bad("mimic of itself", grown("</joint>", '<mimic joint="wrist"/></joint>'), "20:81 E715"),
    Bad(
        "mimics in a circle",
        grown("</joint>", '<mimic joint="hinge"/></joint>').replace(
            "<dynamics", '<mimic joint="wrist"/><dynamics'
        ),
        "17:5 E715, 20:81 E715",
    ),
    Bad(
        "mimic of a fixed joint",
        grown("</joint>", '<mimic joint="hinge"/></joint>').replace("revolute", "fixed"),
        "20:81 E715",
    ),
    Bad(
        "mimic of zero",
        grown("</joint>", '<mimic joint="hinge" multiplier="0.0"/></joint>'),
        "20:114 E715",
    ),
    Bad("mimic without joint", grown("</joint>", "<mimic/></joint>"), "20:81 E706"),
    Bad("nothing moves", changed("revolute", "fixed"), "1:1 E716"),
    Bad(
        "nothing with mass moves",
        changed(MASS, '<mass value="0"/>').replace('"0.1"', '"0"'),
        "11:3 E717",
    ),
    Bad(
        "several faults",
        changed('value="2"', 'value="two"').replace("0 1 0", "0 0 0").replace("<limit", "<limits"),
        "7:20 E707, 15:16 E712, 16:5 E704",
    ),
)
