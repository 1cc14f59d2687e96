"""Writes include/voidage.f90, the Fortran 2008 module, from include/voidage.h: types and interfaces of both kinds, and generic names over them."""

import pathlib
import re
import sys

here = pathlib.Path(__file__).resolve().parent.parent

HEAD = """\
! voidage: porosity of geometry on structured grids, convex bodies, and flow of gas through porous space.
!
! include/voidage.h is the manual. Types and functions have the names they have there, vdg_ for real64
! and vdgf_ for real32; every pair of functions has in addition one generic name without prefix:
! flow_step(flow, dt, report, fault). Fields may be arrays of any rank where the full name is called;
! under a generic name Fortran wants them of rank one. Structs are zero by default and may not be left
! out, nor may arrays that the manual lets be null; pointers in structs come from c_loc. Numbers of bodies, cells,
! axes and sides in arguments and faults count from 0, as there; arrays in structs count from 1.
! This file is made from the header by packaging/fortran.py: do not edit it.
module voidage
  use, intrinsic :: iso_c_binding
  implicit none
  public

"""

KINDS = {"double": "real(c_double)", "float": "real(c_float)", "size_t": "integer(c_size_t)", "int32_t": "integer(c_int32_t)",
         "uint32_t": "integer(c_int32_t)", "uint64_t": "integer(c_int64_t)"}


def declare(kind: str, name: str) -> str:
    """A component of a type, with its default."""
    shape = re.findall(r"\[(\d+)\]", name)
    name = name.split("[")[0].lstrip("*")
    name = {"open": "open_cells", "cut": "cut_cells", "closed": "closed_cells"}.get(name, name)
    return kind, name, f"({', '.join(reversed(shape))})" if shape else ""


def component(line: str, known: list) -> str:
    text = line.strip().rstrip(";").replace("const ", "")
    kind, name = text.split(" ", 1)
    kind, name, shape = declare(kind + ("*" if name.startswith("*") else ""), name)
    if kind.endswith("*"):
        return f"    type(c_ptr) :: {name}{shape} = c_null_ptr"
    if kind in known:
        return f"    type({kind}) :: {name}{shape}"
    zero = "0" if "integer" in KINDS[kind] else f"0.0_{KINDS[kind][5:-1]}"
    return f"    {KINDS[kind]} :: {name}{shape} = {zero}"


def wrapped(line: str) -> str:
    """Lines of at most 100 columns."""
    out = []
    indent = len(line) - len(line.lstrip())
    while len(line) > 100:
        cut = line.rfind(" ", 0, 98)
        out.append(line[:cut] + " &")
        line = " " * (indent + 4) + line[cut + 1:]
    return "\n".join(out + [line])


def argument(text: str, types: list) -> tuple:
    """Name and declaration of an argument."""
    constant, text = text.startswith("const "), text.replace("const ", "").strip()
    kind, name = re.match(r"(\w+) (\**\w+)", text).groups()
    stars, name = name.count("*"), name.lstrip("*")
    if stars == 0:
        return name, f"{KINDS[kind]}, value :: {name}"
    if kind in ("vdg_flow", "vdgf_flow"):
        return name, f"type({kind}), {'value' if stars == 1 else 'intent(out)'} :: {name}"
    if kind == "void":
        return name, f"type(c_ptr), value :: {name}"
    if kind in types:
        return name, f"type({kind}), intent({'in' if constant else 'inout'}) :: {name}"
    if name in ("rate", "contact"):
        return name, f"{KINDS[kind]}, intent(out) :: {name}"
    return name, f"{KINDS[kind]}, intent({'in' if constant else 'inout'}) :: {name}(*)"


def functions(header: str, types: list):
    for result, name, arguments in re.findall(r"(?m)^(vdg_status|size_t) (vdgf?_\w+)\(([^)]*)\);", header):
        pairs = [argument(" ".join(a.split()), types) for a in arguments.split(",")]
        result = KINDS["int32_t"] if result == "vdg_status" else KINDS[result]
        lines = [f"    function {name}({', '.join(n for n, _ in pairs)}) result(answer) bind(c)", "      import"]
        lines += [f"      {d}" for _, d in pairs] + [f"      {result} :: answer", "    end function"]
        yield name, "\n".join(wrapped(line) for line in lines)


def module(header: str) -> str:
    plain = re.sub(r"/\*.*?\*/", "", header, flags=re.DOTALL)
    out = [HEAD]
    version = re.search(r"#define VDG_VERSION (\d+)", plain).group(1)
    out.append(f"  integer(c_int32_t), parameter :: vdg_header_version = {version}\n")
    for name, value in re.findall(r"(?m)^\s*(VDG_\w+) = (\d+),", plain):
        out.append(f"  integer(c_int32_t), parameter :: {name.lower()} = {value}\n")
    types = re.findall(r"\} (vdgf?_\w+);", plain)
    for kind in ("vdg_flow", "vdgf_flow"):
        out.append(f"\n  type, bind(c) :: {kind}\n    type(c_ptr) :: at = c_null_ptr\n  end type\n")
    for body, name in re.findall(r"typedef struct \{(.*?)\} (\w+);", plain, flags=re.DOTALL):
        lines = [component(line, types) for line in body.split("\n") if line.strip()]
        out.append(f"\n  type, bind(c) :: {name}\n" + "\n".join(lines) + "\n  end type\n")
    made = list(functions(plain, types))
    out.append("\n  interface\n" + "\n".join(text for _, text in made))
    out.append("\n    function vdg_version() result(answer) bind(c)\n      import\n      integer(c_int32_t) :: answer\n    end function")
    out.append("\n    function vdg_status_text_at(code) result(answer) bind(c, name=\"vdg_status_text\")\n      import\n"
               "      integer(c_int32_t), value :: code\n      type(c_ptr) :: answer\n    end function\n  end interface\n")
    for name, _ in made:
        if name.startswith("vdg_"):
            generic = name[4:]
            out.append(f"\n  interface {generic}\n    procedure {name}, vdgf_{generic}\n  end interface\n")
    out.append(TEXT)
    return "".join(out)


TEXT = """
contains

  ! A sentence for a status.
  function vdg_status_text(code) result(text)
    integer(c_int32_t), intent(in) :: code
    character(len=:), allocatable :: text
    text = c_text(vdg_status_text_at(code))
  end function

  ! A text in C's memory: the argument that a fault names.
  function c_text(at) result(text)
    type(c_ptr), intent(in) :: at
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: all(:)
    integer :: length
    text = ""
    if (.not. c_associated(at)) return
    call c_f_pointer(at, all, [256])
    do length = 1, 256
      if (all(length) == c_null_char) exit
      text = text // all(length)
    end do
  end function
end module voidage
"""

if __name__ == "__main__":
    written, made = here / "include/voidage.f90", module((here / "include/voidage.h").read_text())
    if "--check" not in sys.argv:
        written.write_text(made)
    elif written.read_text() != made:
        sys.exit("include/voidage.f90 is not what the header says: python3 core/capi/packaging/fortran.py")
