//! Whether the surface in a cell is one unbroken patch.
//!
//! A patch that ends in the sides of a box divides it into two parts, and one alone of a closed body has solid on one side of it and open space on the
//! other: then neither is divided.

/// Memory for one cell at a time.
#[derive(Default)]
pub struct Patches {
    /// A hash table of the edges of pieces, by their ends; the first piece beside each.
    edges: Vec<Edge>,
    /// Places of the table that are taken.
    taken: Vec<usize>,
    /// For each piece the one that it hangs on, itself if it is the first of its patch.
    pieces: Vec<u32>,
}

#[derive(Clone, Copy, Default)]
struct Edge {
    ends: [[f64; 3]; 2],
    piece: u32,
    count: u32,
}

/// Places of the table.
const PLACES: usize = 1 << 10;

/// Cells with more edges are not looked at.
const MOST_EDGES: usize = PLACES / 2;

/// What corners are multiplied with to scatter them over the table.
const SCATTER: u64 = 0x9e37_79b9_7f4a_7c15;

/// A number that scatters a corner over the table by its highest bits.
fn scattered([x, y, z]: [f64; 3]) -> u64 {
    (x.to_bits() ^ y.to_bits().rotate_left(21) ^ z.to_bits().rotate_left(42)).wrapping_mul(SCATTER)
}

impl Patches {
    /// Do pieces of surface, given by their corners, hang together by edges that two of them share, none by one that more share?
    pub fn are_one<'p>(&mut self, pieces: impl Iterator<Item = &'p [[f64; 3]]>) -> bool {
        self.edges.resize(PLACES, Edge::default());
        self.pieces.clear();
        let clear = self.join(pieces);
        for place in self.taken.drain(..) {
            self.edges[place].count = 0;
        }
        clear && (0..self.pieces.len() as u32).filter(|&piece| self.pieces[piece as usize] == piece).count() == 1
    }

    /// Joins pieces that share an edge; false if an edge has more than two, or there are too many.
    fn join<'p>(&mut self, pieces: impl Iterator<Item = &'p [[f64; 3]]>) -> bool {
        for (corners, piece) in pieces.zip(0..) {
            self.pieces.push(piece);
            let Some(mut last) = corners.last() else { continue };
            if self.taken.len() + corners.len() > MOST_EDGES {
                return false;
            }
            let mut last_scattered = scattered(*last);
            for corner in corners {
                let scattered = scattered(*corner);
                // The same for both directions.
                let place = (scattered.wrapping_add(last_scattered) >> (u64::BITS - PLACES.ilog2())) as usize;
                if last != corner && !self.add([*last, *corner], place, piece) {
                    return false;
                }
                (last, last_scattered) = (corner, scattered);
            }
        }
        true
    }

    /// Adds an edge of a piece, which is looked for from a place on; false if two have it already.
    fn add(&mut self, ends: [[f64; 3]; 2], mut place: usize, piece: u32) -> bool {
        loop {
            let edge = &mut self.edges[place];
            if edge.count == 0 {
                *edge = Edge { ends, piece, count: 1 };
                self.taken.push(place);
                return true;
            }
            // Neighbours have it in opposite directions, as a rule.
            if edge.ends == [ends[1], ends[0]] || edge.ends == ends {
                edge.count += 1;
                let (first, clear) = (edge.piece, edge.count == 2);
                let [one, other] = [first, piece].map(|piece| self.first_of(piece));
                self.pieces[one.max(other) as usize] = one.min(other);
                return clear;
            }
            place = (place + 1) % PLACES;
        }
    }

    /// The first piece of a patch.
    fn first_of(&self, mut piece: u32) -> u32 {
        while self.pieces[piece as usize] != piece {
            piece = self.pieces[piece as usize];
        }
        piece
    }
}
