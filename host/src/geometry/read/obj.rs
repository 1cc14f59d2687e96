//! Wavefront OBJ: vertices and polygons; materials, normals and texture coordinates are passed over.
//!
//! Our own reader, because `tobj` forgets the line of an error, takes some bad indices for good ones and cuts polygons into fans.
//! Lines may be continued by a backslash; indices count from 1, or back from the last vertex if negative, and may point to
//! vertices that come later. Every `o` and `g` begins a solid. Reference: *Object Files (.obj)*, Wavefront Advanced Visualizer
//! manual, appendix B1.

use std::path::Path;

use glam::DVec3;

use super::polygon::{EarClipper, Split};
use super::text::{OddityCount, SingleDigits, Token, Tokens, quote};
use crate::error::{Error, Result};
use crate::geometry::mesh::{Mesh, Solid};

/// Reads all faces of a text.
pub fn read(path: &Path, text: &[u8]) -> Result<Mesh> {
    let mut reader = Reader::new(path, text);
    while let Some(keyword) = reader.tokens.next() {
        reader.statement(keyword)?;
        while reader.tokens.next_in_line().is_some() {}
        reader.tokens.skip_line_from(reader.tokens.at());
    }
    reader.finish()
}

struct Reader<'a> {
    path: &'a Path,
    tokens: Tokens<'a>,
    vertices: Vec<DVec3>,
    digits: SingleDigits,
    /// Indices into `vertices`, counted from 0, of all faces; checked at the end.
    corners: Vec<usize>,
    faces: Vec<Face>,
    /// Names, each with the number of faces before it.
    names: Vec<(String, usize)>,
    oddities: Oddities,
}

struct Face {
    /// End of its corners in [`Reader::corners`]; they begin where those of the face before end.
    end: usize,
    /// Offset in the text.
    at: usize,
}

/// What is passed over, and warned of.
#[derive(Default)]
struct Oddities {
    short: OddityCount,
    curved: OddityCount,
    unknown: OddityCount,
    forced: OddityCount,
}

/// Statements that say nothing about the surface.
const IGNORED: &[&str] = &[
    "vt",
    "vn",
    "l",
    "p",
    "s",
    "mg",
    "mtllib",
    "usemtl",
    "maplib",
    "usemap",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "res",
];

/// Statements of curves and surfaces without facets.
const CURVED: &[&str] = &[
    "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con",
    "ctech", "stech", "bsp", "bzp", "cdc", "cdp",
];

impl<'a> Reader<'a> {
    fn new(path: &'a Path, text: &'a [u8]) -> Self {
        let (digits, oddities) = (SingleDigits::default(), Oddities::default());
        let (vertices, corners, faces, names) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Reader { path, tokens: Tokens::new(text), vertices, digits, corners, faces, names, oddities }
    }

    fn statement(&mut self, keyword: Token) -> Result<()> {
        let is_one_of = |keywords: &[&str]| keywords.iter().any(|name| keyword.is(name));
        if keyword.is("v") {
            return self.vertex(keyword);
        }
        if is_one_of(&["f", "fo"]) {
            return self.face(keyword);
        }
        if is_one_of(&["o", "g"]) {
            self.name();
        } else if keyword.bytes.starts_with(b"#") {
            self.tokens.skip_line_from(keyword.at);
        } else if is_one_of(CURVED) {
            self.oddities.curved.add(keyword.at);
        } else if !is_one_of(IGNORED) {
            self.oddities.unknown.add(keyword.at);
        }
        Ok(())
    }

    /// `v X Y Z`, perhaps with a weight or a colour.
    fn vertex(&mut self, keyword: Token) -> Result<()> {
        let mut vertex = [0.0; 3];
        for (i, coordinate) in vertex.iter_mut().enumerate() {
            let Some(token) = self.tokens.next_in_line() else {
                return Err(self.error(keyword.at, format!("a vertex has three coordinates, found {i}")));
            };
            *coordinate = token.number().map_err(|reason| self.error(token.at, reason))?;
            self.digits.see(token.bytes, *coordinate);
        }
        self.vertices.push(DVec3::from_array(vertex));
        Ok(())
    }

    /// `f` and three or more of `V`, `V/T`, `V//N`, `V/T/N`.
    fn face(&mut self, keyword: Token) -> Result<()> {
        let start = self.corners.len();
        while let Some(token) = self.tokens.next_in_line() {
            let corner = self.corner(token)?;
            self.corners.push(corner);
        }
        if self.corners.len() - start < 3 {
            self.oddities.short.add(keyword.at);
            self.corners.truncate(start);
        } else {
            self.faces.push(Face { end: self.corners.len(), at: keyword.at });
        }
        Ok(())
    }

    /// Index of a vertex, from 0. Whether there is such a vertex shows at the end of the file, unless it is negative.
    fn corner(&self, token: Token) -> Result<usize> {
        let digits = token.bytes.split(|&byte| byte == b'/').next().unwrap_or(token.bytes);
        let index = std::str::from_utf8(digits).ok().and_then(|text| text.parse::<i64>().ok());
        match index {
            None => Err(self.error(token.at, format!("{} is not the index of a vertex", quote(token.bytes)))),
            Some(0) => Err(self.error(token.at, "index 0, but OBJ counts vertices from 1".into())),
            Some(index) if index > 0 => Ok(usize::try_from(index - 1).unwrap_or(usize::MAX)),
            Some(index) => {
                let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
                let reason = || format!("index {index}, but only {} vertices come before", self.vertices.len());
                self.vertices.len().checked_sub(back).ok_or_else(|| self.error(token.at, reason()))
            }
        }
    }

    /// `o NAME` or `g NAME…`: a solid begins.
    fn name(&mut self) {
        let name = self.tokens.trimmed(self.tokens.at(), self.tokens.line_end());
        // A name without faces, as of an object before the name of its first group, gives way to the next.
        self.names.pop_if(|last| last.1 == self.faces.len());
        self.names.push((name, self.faces.len()));
        self.tokens.go_to(self.tokens.line_end());
    }

    fn finish(mut self) -> Result<Mesh> {
        if self.faces.is_empty() {
            let reason = format!("no faces: {} vertices, but no `f` with three of them", self.vertices.len());
            return Err(Error::at(self.path, self.tokens.last_line(), self.with_first_unknown(reason)));
        }
        let mut mesh = Mesh::of_file(self.path);
        let firsts = self.triangulate(&mut mesh)?;
        mesh.solids = self.solids(&firsts);
        mesh.single_precision = self.digits.are_single();
        let Oddities { short, curved, unknown, forced } = self.oddities;
        let sentences = [
            (short, "face with fewer than three corners; ignored"),
            (curved, "statement of a free-form curve or surface, which is not read; ignored"),
            (unknown, "unknown statement; ignored"),
            (forced, "face without area or with edges that cross; split into triangles somehow"),
        ];
        for (tally, what) in sentences {
            if let Some(sentence) = tally.sentence(what, &self.tokens) {
                mesh.warn(sentence);
            }
        }
        Ok(mesh)
    }

    /// If there was an unknown statement, it may be the very reason.
    fn with_first_unknown(&self, reason: String) -> String {
        match self.oddities.unknown.sentence("unknown statement", &self.tokens) {
            Some(sentence) => format!("{reason}; {sentence}"),
            None => reason,
        }
    }

    /// Splits all faces into triangles. Returns the first triangle of every face, and the end.
    fn triangulate(&mut self, mesh: &mut Mesh) -> Result<Vec<usize>> {
        let mut firsts = Vec::with_capacity(self.faces.len() + 1);
        let (mut ears, mut polygon, mut start) = (EarClipper::new(), Vec::new(), 0);
        for face in &self.faces {
            firsts.push(mesh.triangles.len());
            polygon.clear();
            for (n, &corner) in self.corners[start..face.end].iter().enumerate() {
                let vertex = self.vertices.get(corner).ok_or_else(|| self.out_of_range(face, n, corner))?;
                polygon.push(*vertex);
            }
            start = face.end;
            match ears.split(&polygon, |triangle| mesh.triangles.push(triangle.map(|i| polygon[i]))) {
                Split::Clean => {}
                Split::Forced => self.oddities.forced.add(face.at),
                Split::TooComplex => {
                    let reason = format!("a face of {} corners, too winding to be split into triangles", polygon.len());
                    return Err(self.error(face.at, reason));
                }
            }
        }
        firsts.push(mesh.triangles.len());
        Ok(firsts)
    }

    /// The runs of triangles that the names begin, without those that have none.
    fn solids(&mut self, firsts: &[usize]) -> Vec<Solid> {
        let mut starts = vec![(String::new(), 0)];
        starts.append(&mut self.names);
        let ends: Vec<usize> = starts[1..].iter().map(|start| start.1).chain([self.faces.len()]).collect();
        let runs = starts.into_iter().zip(ends).filter(|((_, start), end)| start < end);
        runs.map(|((name, start), end)| Solid { name, triangles: firsts[start]..firsts[end] }).collect()
    }

    /// The `n`-th corner of a face is no vertex of the file.
    fn out_of_range(&self, face: &Face, n: usize, corner: usize) -> Error {
        let reason = format!("index {}, but there are {} vertices", corner as u64 + 1, self.vertices.len());
        let mut tokens = self.tokens.clone();
        tokens.go_to(face.at);
        let keyword = tokens.next();
        let index = std::iter::from_fn(|| tokens.next_in_line()).nth(n);
        self.error(index.or(keyword).map_or(face.at, |token| token.at), reason)
    }

    fn error(&self, at: usize, reason: String) -> Error {
        self.tokens.error(self.path, at, reason)
    }
}
