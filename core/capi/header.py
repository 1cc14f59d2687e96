"""A header from cbindgen, from standard input to output.

Comments lose the parts that are for readers of Rust and take one line where one will do; constants get a plain type, the same in C and C++; structs
of single precision are told by those of double precision.
"""

import re
import sys


def comment(match: re.Match) -> str:
    indent, body = match.group(1), match.group(2)
    lines = [line.strip() for line in body.strip().splitlines()]
    if "# Safety" in lines:
        lines = lines[: lines.index("# Safety")]
    while lines and not lines[-1]:
        lines.pop()
    lines = [line.replace("`", "") for line in lines]
    text = f"\n{indent} * ".join(lines)
    return f"{indent}/* {text} */".replace("* \n", "*\n")


def single(match: re.Match) -> str:
    name = match.group(3)
    if not name.startswith("vdgf_"):
        return match.group(0)
    fields = re.sub(r"[ ]*/\*.*?\*/\n", "", match.group(2), flags=re.DOTALL)
    return f"/* As vdg_{name[5:]}, in single precision. */\ntypedef struct {{\n{fields}\n}} {name};"


header = sys.stdin.read()
header = re.sub(r"(?m)^([ ]*)/\*\n((?:(?!\*/).*\n)*?)[ ]*\*/", comment, header)
header = re.sub(r"enum (vdg_\w+)\n#if.*\n.*\n#endif.*\n \{", r"typedef int32_t \1;\nenum {", header)
header = re.sub(r"(?m)^#ifndef __cplusplus\n#if __STDC.*\ntypedef.*\n#else\ntypedef.*\n#endif.*\n#endif.*\n", "", header)
header = re.sub(r"(/\*(?:(?!\*/).)*\*/\n)typedef struct \{\n(.*?)\n\} (\w+);", single, header, flags=re.DOTALL)
header = re.sub(r"/\* A flow\.[^/]*/\n(?=typedef struct vdgf_flow)", "/* As vdg_flow, in single precision. */\n", header)
header = re.sub(r"(?m) +//.*$", "", header)
sys.stdout.write(re.sub(r"\n{3,}", "\n\n", header))
