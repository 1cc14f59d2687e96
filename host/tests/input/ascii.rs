//! ASCII STL.

use std::path::Path;

use super::{ascii, binary, facets, is_box, is_refused, is_sound, names, stl};
use glam::DVec3;
use voidage::geometry::read::from_bytes;

#[test]
fn ascii_coordinates_are_doubles() {
    let mesh = is_box(stl(ascii()), 0);
    assert_eq!(mesh.triangles[0], [DVec3::new(0.3, 1.2, 0.1), DVec3::new(2.3, 1.2, 0.1), DVec3::new(2.3, 0.2, 0.1)]);
    assert_eq!(names(&mesh), ["cube"]);
}

#[test]
fn ascii_in_other_hands() {
    let text = ascii();
    is_box(stl(text.replace('\n', "\r\n")), 0);
    is_box(stl(text.replace('\n', "\r")), 0);
    is_box(stl(text.replace(' ', "\t")), 0);
    is_box(stl(text.to_uppercase()), 0);
    is_box(stl(format!("\u{feff}{text}")), 0);
    is_box(stl(format!("\n \n  {text}")), 0);
    is_box(stl(text.trim_end()), 0);
    is_box(stl(text.replace("0.3", "+3.0E-1").replace("1.1", "11.e-1").replace("0.1", ".1")), 0);
    is_box(stl(text.replace("normal 0 0 1", "normal nan -nan(ind) 1.#QNAN")), 0);
    // Content decides, whatever the name.
    is_box(from_bytes(Path::new("case.obj"), text.clone().into()), 0);
    is_box(from_bytes(Path::new("case"), text.into()), 0);
}

#[test]
fn names_of_solids() {
    let named = |name: &[u8]| [b"solid ", name, b"\n", facets().as_bytes(), b"endsolid ", name, b"\n"].concat();
    let name = |bytes: Vec<u8>| is_box(stl(bytes), 0).solids[0].name.clone();
    assert_eq!(name(named(b"")), "");
    assert_eq!(name(ascii().replace(" cube", "").into()), "");
    assert_eq!(name(named("Träger 7".as_bytes())), "Träger 7");
    assert_eq!(name(named(b"Tr\xe4ger\t")), "Träger");
    assert_eq!(name(named(b"facet normal 0 0 1 outer solid endsolid")), "facet normal 0 0 1 outer solid endsolid");
    assert_eq!(name(named(&[b'n'; 100_000])).len(), 100_000);
    assert_eq!(name(named(&[0xe4; 10_000])).chars().count(), 10_000);
}

#[test]
fn several_solids_keep_their_names() {
    let other = ascii().replace("cube", "b c");
    let mesh = stl(format!("{}{other}solid void\nendsolid void\n", ascii())).unwrap();
    is_sound(&mesh);
    assert_eq!(names(&mesh), ["cube", "b c", "void"]);
    assert_eq!([&mesh.solids[0].triangles, &mesh.solids[1].triangles], [&(0..12), &(12..24)]);
    assert_eq!(mesh.solids[2].triangles, 24..24);
    assert!(
        mesh.warnings.len() == 1 && mesh.warnings[0].contains("without triangles (first: line 17"),
        "{:?}",
        mesh.warnings
    );
}

#[test]
fn all_on_one_line() {
    let line = |text: String| text.replace('\n', " ");
    assert_eq!(names(&is_box(stl(line(ascii())), 0)), ["cube"]);
    let two = line(ascii() + &ascii().replace("cube", "ball"));
    assert_eq!(names(&stl(two).unwrap()), ["cube", "ball"]);
    // The facets may begin on the line of the name, too.
    assert_eq!(names(&is_box(stl(ascii().replacen("cube\n", "cube", 1)), 0)), ["cube"]);
}

#[test]
fn ascii_with_warnings() {
    let text = ascii();
    is_box(stl(text.replace("endsolid cube\n", "")), 1);
    is_box(stl(text.replace(" normal 0 0 1", "")), 1);
    is_box(stl(text.replacen("normal 0 0 1", "normal 0 0", 1)), 1);
    is_box(stl(text.replace("  facet", "# a comment, facet normal\n  facet")), 1);
    is_box(stl(format!("// made by hand\n# on a Monday\n{text}")), 1);
    is_box(stl(format!("{text}this is no STL\n")), 1);
    is_box(stl([text.as_bytes(), &binary(b"", 12, b"")].concat()), 1);
    is_box(stl(facets()), 2);
    let joined = format!("solid a\n{}solid b\n{}endsolid b", facets(), facets());
    let mesh = stl(joined).unwrap();
    assert_eq!((names(&mesh), mesh.warnings.len()), (vec!["a", "b"], 1));
}

#[test]
fn ascii_errors_name_line_and_token() {
    let edit = |from: &str, to: &str| stl(ascii().replacen(from, to, 1));
    is_refused(edit("vertex 2.3 1.2", "vertex 2.3abc 1.2"), &["line 5", "`2.3abc`", "not a number"]);
    is_refused(edit("vertex 2.3", "vertex 2,3"), &["line 5", "`2,3`", "comma"]);
    is_refused(edit("vertex 2.3", "vertex 2.3D0"), &["line 5", "`2.3D0`", "exponent"]);
    is_refused(edit("vertex 2.3", "vertex nan"), &["line 5", "`nan`", "not finite"]);
    is_refused(edit("vertex 2.3", "vertex 1e999"), &["line 5", "`1e999`", "not finite"]);
    is_refused(edit("vertex 2.3", "vertex"), &["line 6", "`vertex`", "not a number"]);
    is_refused(edit("vertex 2.3", "vertex \0"), &["line 5", r"`\0`"]);
    is_refused(edit("      vertex 0.3 1.2 0.1\n", ""), &["line 6", "`vertex`", "`endloop`"]);
    is_refused(edit("    endloop\n", "      vertex 1 2 3\n    endloop\n"), &["line 7", "expected `endloop`"]);
    is_refused(edit("    endloop\n", ""), &["line 7", "expected `endloop`", "`endfacet`"]);
    is_refused(edit("  endfacet\n", ""), &["line 8", "expected `endfacet`"]);
    is_refused(edit("outer", "inner"), &["line 3", "expected `outer`", "`inner`"]);
    is_refused(edit("facet normal", "triangle"), &["line 2", "expected `facet` or `endsolid`", "`triangle`"]);
    is_refused(edit("0.3", &"9".repeat(1000)), &["line 4", "…"]);
    let crlf = ascii().replace('\n', "\r\n").replacen("vertex 2.3", "vertex x", 1);
    is_refused(stl(crlf), &["line 5"]);
    let cr = ascii().replace('\n', "\r").replacen("vertex 2.3", "vertex x", 1);
    is_refused(stl(cr), &["line 5"]);
    // Words between solids would hide the solid behind them.
    is_refused(stl(format!("{}and then\n{}", ascii(), ascii())), &["line 87", "`and`"]);
}

#[test]
fn ascii_cut_short() {
    let text = ascii();
    // Anywhere within facets; behind the last one only `endsolid` is missing.
    for end in (30..text.rfind("endfacet").unwrap()).step_by(7) {
        let cut = &text[..end];
        match stl(cut) {
            Err(error) => assert!(error.to_string().contains("line "), "{error}"),
            Ok(mesh) => assert!(cut.trim_end().ends_with("endfacet") && mesh.warnings.len() == 1, "{cut}"),
        }
    }
    is_refused(stl("solid\n"), &["no triangles", "84"]);
    is_refused(stl("solid"), &["no triangles"]);
    is_refused(stl("solid a\nendsolid a\n"), &["no triangles", "line 2"]);
    is_refused(stl("solid advice: do not mesh by hand.\n".repeat(10)), &["line 2", "`solid`"]);
}

#[test]
fn colours_say_nothing_about_the_surface() {
    let text = ascii();
    let names_of = |text: String| names(&is_box(stl(text), 0)).join("|");
    assert_eq!(names_of(text.replacen("solid cube", "solid cube color 0.5 0.25 1", 1)), "cube");
    assert_eq!(names_of(text.replacen("solid cube\n", "solid cube\ncolor 0.5 0.25 1\n", 1)), "cube");
    assert_eq!(names_of(text.replace("  facet", "  color 1 0 0\n  facet")), "cube");
    assert_eq!(names_of(text.replacen("solid cube", "solid COLOR 1 0 0", 1)), "");
    assert_eq!(names_of(text.replacen("solid cube", "solid no color 1 0", 1)), "no color 1 0");
    assert_eq!(names_of(text.replacen("cube", "cube color 1 0 0", 1).replace('\n', " ")), "cube");
    is_refused(stl(text.replacen("solid cube", "solid cube\ncolor red", 1)), &["line 2", "`red`", "not a number"]);
}

#[test]
fn ends_in_two_words() {
    let text =
        ascii().replace("endloop", "end loop").replace("endfacet", "END facet").replace("endsolid", "end  solid");
    assert_eq!(names(&is_box(stl(text.clone()), 0)), ["cube"]);
    assert_eq!(names(&is_box(stl(text.replace('\n', " ")), 0)), ["cube"]);
    let two = text.clone() + &text.replace("cube", "ball");
    assert_eq!(names(&stl(two.replace('\n', " ")).unwrap()), ["cube", "ball"]);
    is_refused(stl(text.replacen("end loop", "end", 1)), &["expected `endloop`", "`end`"]);
}
