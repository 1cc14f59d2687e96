//! Cells that regions hold in part: what of the gas of such a cell each region keeps.
//!
//! Let O(a…b) be the open part of a cell in which the regions from a to b stand as solids, beside those of the scene. Of what region a holds the regions
//! after it, up to b, leave O(a + 1…b) − O(a…b), wherever in the cell solids and regions lie: the volume of a union, found as the porosity of a scene is.
//! It is found where two regions cut a cell, or a region and solids do; elsewhere the share of the cell's volume says it. Where the open
//! fractions come from files, it is not known where in a cell the solids lie: they take as much of each part of it.

use super::arrays::{index, position};
use super::regions::Region;
use super::space::SceneBodies;
use crate::command::progress::Progress;
use crate::command::stages;
use crate::error::{Error, Result};
use crate::geometry::bodies::{Bodies, OwnDrag};
use crate::geometry::scene::placement::Placement;
use crate::geometry::scene::{Scene, SceneSolid, load};
use crate::grid::Edges;
use crate::porosity::{self, Options, porosity};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

/// A region that holds some of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Its place in the list of the case.
    pub region: usize,
    /// Its share of the volume of the cell, 1 where it holds all of it.
    pub share: f64,
}

/// What stands in the cells of a case at its beginning.
#[derive(Debug, Clone, Copy)]
pub struct Standing<'a> {
    /// Edges of the cells.
    pub edges: &'a Edges,
    /// All regions, in their order.
    pub regions: &'a [Region],
    /// Solids, if it is known where they are.
    pub scene: Option<&'a SceneBodies>,
    /// Open fractions of the cells, if they are not 1.
    pub beta_v: Option<&'a [f64]>,
}

/// What runs of regions leave of the open parts of cells.
#[derive(Debug, Clone, Default)]
pub struct OpenParts {
    /// By the first and the last region of a run, and by cell: the share of its open part that none of them holds.
    left: BTreeMap<[usize; 2], FxHashMap<usize, f64>>,
}

/// A share of an open part this close to none or all is rounding.
const ROUNDING: f64 = 1e-12;

/// A cell that is less open than this is too small a space for its parts to be told apart.
const LEAST_OPEN: f64 = 1e-9;

impl OpenParts {
    /// The parts of cells that some regions hold, each list in the order of the regions.
    ///
    /// # Errors
    /// There is no memory for them.
    pub fn measure<'h>(
        standing: &Standing,
        cells: impl Iterator<Item = (usize, &'h [Hold])>,
        progress: &mut Progress,
    ) -> Result<Self> {
        let mut wanted: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (cell, holds) in cells {
            for run in standing.runs(cell, holds) {
                wanted.entry(run).or_default().push(cell);
            }
        }
        if wanted.is_empty() {
            return Ok(OpenParts::default());
        }
        let left = |(run, cells): (&[usize; 2], &Vec<usize>)| Ok((*run, standing.left(*run, cells)?));
        let left = progress.stage("regions", |_| wanted.iter().map(left).collect::<Result<_>>())?;
        Ok(OpenParts { left })
    }

    /// Nothing had to be found: shares of cells say it all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.left.is_empty()
    }

    /// The share of the open part of a cell that none of these regions holds. Where that was not found they hold different parts of the cell.
    #[must_use]
    pub fn left(&self, cell: usize, holds: &[Hold]) -> f64 {
        let (Some(first), Some(last)) = (holds.first(), holds.last()) else { return 1.0 };
        if holds.iter().any(|hold| hold.share == 1.0) {
            return 0.0;
        }
        let held: f64 = holds.iter().map(|hold| hold.share).sum();
        self.found([first.region, last.region], cell).unwrap_or((1.0 - held).max(0.0))
    }

    /// The share of the open part of a cell that a region holds, whatever regions after it leave of that.
    #[must_use]
    pub fn held(&self, cell: usize, hold: Hold) -> f64 {
        self.found([hold.region; 2], cell).map_or(hold.share, |left| 1.0 - left)
    }

    fn found(&self, run: [usize; 2], cell: usize) -> Option<f64> {
        self.left.get(&run)?.get(&cell).copied()
    }
}

impl Standing<'_> {
    /// First and last regions of the runs whose union is asked for in a cell.
    fn runs(&self, cell: usize, holds: &[Hold]) -> Vec<[usize; 2]> {
        let open = self.beta_v.map_or(1.0, |beta| beta[cell]);
        let cut = self.scene.is_some() && open < 1.0;
        let mut runs = Vec::new();
        if open > LEAST_OPEN {
            for (n, first) in holds.iter().enumerate() {
                // With a region that holds all of the cell, nothing is left.
                let partial = holds[n..].iter().take_while(|hold| hold.share < 1.0);
                let ends = partial.skip(usize::from(!cut));
                runs.extend(ends.map(|last| [first.region, last.region]));
            }
        }
        runs
    }

    /// The share of the open part of each of these cells that no region of a run holds.
    fn left(&self, [first, last]: [usize; 2], cells: &[usize]) -> Result<FxHashMap<usize, f64>> {
        let all = self.edges.cells();
        let ranges = block(cells, all);
        let block = Edges([0, 1, 2].map(|a| self.edges.0[a][ranges[a].start..=ranges[a].end].to_vec()));
        let [lo, hi] = block.bounds();
        let near = |[min, max]: [DVec3; 2]| min.cmple(hi).all() && max.cmpge(lo).all();
        let mut bodies = self.scene.map_or_else(Bodies::default, |scene| {
            let all = &scene.bodies;
            all.some(|body| near(all.bodies[body].bounds))
        });
        let shapes = self.regions[first..=last].iter().filter_map(|region| region.shape([lo, hi]));
        let solid = |shape| SceneSolid {
            name: String::new(),
            place: Error::new(""),
            shape,
            porosity: 0.0,
            drag: OwnDrag::default(),
            placement: Placement { turn: None, angle: 0.0, translate: DVec3::ZERO, count: [1; 3], step: DVec3::ZERO },
        };
        load::add(&Scene { path: PathBuf::new(), solids: shapes.map(solid).collect(), grid: None }, &mut bodies)?;
        let usual = self.scene.map_or_else(Options::default, |scene| scene.options);
        let options = Options { areas: false, bounds: false, resistance: false, ..usual };
        let grid = block.grid(None)?;
        stages::room_for(porosity::memory(&grid, &bodies, options))?;
        let beta = porosity(&grid, &bodies, options).beta.v;
        let share = |cell: usize| {
            let at = index(cell, all);
            let in_block = position([0, 1, 2].map(|a| at[a] - ranges[a].start), block.cells());
            let open = self.beta_v.filter(|_| self.scene.is_some()).map_or(1.0, |beta| beta[cell]);
            match beta[in_block] / open {
                left if left < ROUNDING => 0.0,
                left if left > 1.0 - ROUNDING => 1.0,
                left => left,
            }
        };
        Ok(cells.iter().map(|&cell| (cell, share(cell))).collect())
    }
}

/// The smallest block of a grid of so many cells that has all of these cells.
fn block(cells: &[usize], all: [usize; 3]) -> [Range<usize>; 3] {
    let mut ranges = all.map(|count| count..0);
    for &cell in cells {
        for (range, at) in ranges.iter_mut().zip(index(cell, all)) {
            *range = range.start.min(at)..range.end.max(at + 1);
        }
    }
    ranges
}
