"""Writes src/single.rs: the text of src/double.rs in single precision, its comments pointing at the functions of double precision."""

import pathlib
import re
import subprocess

here = pathlib.Path(__file__).parent


def single(double: str) -> str:
    text = re.sub(
        r"(?m)(?:^///.*\n)+(?=#\[unsafe\(no_mangle\)\]\npub unsafe extern \"C\" fn (vdg_\w+))",
        r"/// As `\1`, in single precision.\n///\n/// # Safety\n/// As of `\1`.\n",
        double,
    )
    text = text.replace("f64", "f32").replace("fn vdg_", "fn vdgf_")
    return text.replace("//! The functions of double precision.", "//! The functions of single precision, made by `single.py` from `double.rs`.")


if __name__ == "__main__":
    written = here / "src/single.rs"
    written.write_text(single((here / "src/double.rs").read_text()))
    subprocess.run(["rustfmt", "--edition", "2024", written], check=True)
