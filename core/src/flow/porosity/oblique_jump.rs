//! Fluxes through a face where the open area jumps across a border that is askew to the grid.
//!
//! The stationary wave of a border changes the velocity normal to it alone, n · u; what runs along the border passes as it is. So of the area by which a duct is wider
//! than the open part of the face, gas passes (n · u) n_d for the axis d of the face, and the pressure there acts along n: a cell with the duct area a meets a face of open
//! area b with the vector area g = b e_d + (a − b) n_d n. For n = e_d that is the duct area of a border aligned with the grid.
//!
//! A uniform stream that passes a plane layer keeps its total pressure: g · u is then the same from both sides of each face, and what enters
//! a cell leaves it, because the area vector of its walls is along n.

use crate::flow::face_gas::FaceGases;
use crate::flow::porosity::jump::{JumpLane, ThroatCall, acoustic, carried_by_flux, densities, taken_up, weakness};
use crate::flow::porosity::throat::{AtThroat, ThroatGas};
use crate::flow::riemann::Flux;
use crate::flow::state::{Primitive, dot};
use crate::number::real::Real;

/// An open face at which the porosity jumps across a border askew to the grid. Vectors in the frame of the axis of the face.
pub(in crate::flow) struct ObliqueJump<R, const D: usize> {
    /// States on the left and on the right.
    pub states: [Primitive<R, D>; 2],
    /// Duct areas.
    pub ducts: [R; 2],
    /// Open area of the face, and of the throat.
    pub open: R,
    pub throat: R,
    /// Pressures that act on the walls inside each cell at this face.
    pub references: [R; 2],
    /// As for [`JumpFaces`](super::jump::JumpFaces).
    pub acoustic_weight: R,
    /// Unit vector normal to the border; its first component is not negative.
    pub normal: [R; D],
}

/// What passes such a face, areas included.
pub(in crate::flow) struct ObliqueFlux<R, const D: usize> {
    /// Mass and energy per time.
    pub mass: R,
    pub energy: R,
    /// Momentum that each cell loses (left) or gains (right), less its vector area times its reference pressure.
    pub momentum: [[R; D]; 2],
    /// As for [`JumpFlux`](super::jump::JumpFlux).
    pub carried: [R; 2],
}

/// One side of the face.
struct Side<R, const D: usize> {
    /// Velocity along the border, and normal to it.
    along: [R; D],
    through: R,
    /// The state at the throat; its velocity is that normal to the border.
    throat: Primitive<R, 1>,
    /// Area of the stream that passes.
    passing: R,
    /// Vector area of that stream, its size and direction.
    area: [R; D],
    size: R,
    direction: [R; D],
    /// What passes the face if this side alone tells.
    mass: R,
}

/// a + s b.
fn plus<R: Real, const D: usize>(a: [R; D], s: R, b: [R; D]) -> [R; D] {
    core::array::from_fn(|c| a[c] + s * b[c])
}

/// The half turn that takes the first axis to a direction with a first component above −1, and back.
fn turned<R: Real, const D: usize>(v: [R; D], direction: [R; D]) -> [R; D] {
    let mut middle = direction;
    middle[0] += R::ONE;
    let twice = dot(v, middle) / middle[0];
    core::array::from_fn(|c| twice * middle[c] - v[c])
}

impl<R: Real, const D: usize> ObliqueJump<R, D> {
    /// Vector area of a face of so much open area as a duct of another meets it.
    fn area(&self, duct: R) -> [R; D] {
        let mut area = self.normal.map(|n| (duct - self.open) * (self.normal[0] * n));
        area[0] += self.open;
        area
    }

    /// What side `s` brings to the throat, of its duct as much as a stream of area `from`.
    fn side(&self, (s, from): (usize, R), throat: &ThroatGas<R>) -> Side<R, D> {
        let (w, n) = (&self.states[s], self.normal);
        let through = dot(n, w.velocity);
        let normal = Primitive { density: w.density, velocity: [through], pressure: w.pressure };
        let AtThroat { state, passing } = throat.carry(&normal, from, self.throat);
        let along = plus(w.velocity, -through, n);
        let area = self.area(passing);
        let size = dot(area, area).sqrt();
        // What runs along the border passes the open part of the face, by the density in the throat: from both sides the same.
        let mass = self.open * state.density * along[0] + passing * (w.density * through) * n[0];
        Side { along, through, throat: state, passing, area, size, direction: area.map(|a| a / size), mass }
    }

    /// The flux; `solve` is the Riemann solver in the throat.
    pub(in crate::flow) fn flux(
        &self,
        gas: &impl FaceGases<R>,
        throat: [&ThroatGas<R>; 2],
        solve: ThroatCall<R, D>,
    ) -> ObliqueFlux<R, D> {
        // Written out: `map` of an array calls a function for what it makes of an element this large.
        let mut sides = [self.side((0, self.ducts[0]), throat[0]), self.side((1, self.ducts[1]), throat[1])];
        let chokes = (0..2).any(|s| sides[s].passing < self.ducts[s]);
        let across = self.area(self.throat);
        let size = dot(across, across).sqrt();
        let direction = across.map(|a| a / size);
        // In the throat, the direction of its area first.
        let turn = |side: &Side<R, D>| {
            let t = &side.throat;
            let velocity = turned(plus(side.along, t.velocity[0], self.normal), direction);
            Primitive { density: t.density, velocity, pressure: t.pressure }
        };
        let mut at_throat = [turn(&sides[0]), turn(&sides[1])];
        let weak = self.weak(&sides, gas);
        let along =
            |t: &Primitive<R, D>| Primitive { density: t.density, velocity: [t.velocity[0]], pressure: t.pressure };
        let first = [along(&at_throat[0]), along(&at_throat[1])];
        let share = if chokes { R::ZERO } else { self.acoustic_weight * weakness(weak.mass / size, &first, gas) };
        if share >= R::ONE {
            return weak;
        }
        let through = [sides[0].through, sides[1].through];
        let from = taken_up(&self.states, through, (self.ducts, self.throat), gas);
        for s in 0..2 {
            if from[s] < sides[s].passing {
                sides[s] = self.side((s, from[s]), throat[s]);
                at_throat[s] = turn(&sides[s]);
            }
        }
        let solved = solve(&at_throat, &[*gas.left(), *gas.right()]);
        let strong = self.strong(&sides, throat, &at_throat, (size, direction), (&solved, gas));
        let mix = |a: R, b: R| if share > R::ZERO { share * a + (R::ONE - share) * b } else { b };
        ObliqueFlux {
            mass: mix(weak.mass, strong.mass),
            energy: mix(weak.energy, strong.energy),
            momentum: core::array::from_fn(|s| {
                core::array::from_fn(|c| mix(weak.momentum[s][c], strong.momentum[s][c]))
            }),
            carried: core::array::from_fn(|v| mix(weak.carried[v], strong.carried[v])),
        }
    }

    /// The fluxes of strong waves, from the flux of the Riemann problem in the throat.
    fn strong(
        &self,
        sides: &[Side<R, D>; 2],
        gas: [&ThroatGas<R>; 2],
        at_throat: &[Primitive<R, D>; 2],
        (size, direction): (R, [R; D]),
        (f, face_gas): (&Flux<R, D>, &impl FaceGases<R>),
    ) -> ObliqueFlux<R, D> {
        let momentum = |s: usize| {
            let (w, side, t) = (&self.states[s], &sides[s], &at_throat[s]);
            // Impulse in the throat, and in the cell relative to the reference pressure.
            let of_throat = turned(t.velocity, direction);
            let change: [R; D] = core::array::from_fn(|c| side.mass * (w.velocity[c] - of_throat[c]));
            // Less the pressure before it is turned, so that gas at rest feels none.
            let mut impulse = f.momentum;
            impulse[0] -= t.pressure;
            let at_throat = turned(impulse, direction).map(|m| size * m);
            let stream = plus(change, w.pressure - self.references[s], side.area);
            let blocked = self.ducts[s] - side.passing;
            let walls = if blocked > R::ZERO {
                let into_wall = if s == 0 { side.through } else { -side.through };
                blocked * gas[s].relative_wall_pressure(w, into_wall, self.references[s])
            } else {
                R::ZERO
            };
            let sum: [R; D] = core::array::from_fn(|c| at_throat[c] + stream[c]);
            plus(sum, walls * self.normal[0], self.normal)
        };
        ObliqueFlux {
            mass: size * f.mass,
            energy: size * f.energy,
            momentum: [momentum(0), momentum(1)],
            carried: carried_by_flux(f, size, [self.states.each_ref(), at_throat.each_ref()].map(densities), face_gas),
        }
    }

    /// The fluxes of weak waves, which run along the vector areas.
    fn weak(&self, sides: &[Side<R, D>; 2], gas: &impl FaceGases<R>) -> ObliqueFlux<R, D> {
        let cell = |s: usize| {
            let (w, side) = (&self.states[s], &sides[s]);
            let velocity = [side.mass / (side.size * w.density)];
            Primitive { density: w.density, velocity, pressure: w.pressure }
        };
        let sizes = [sides[0].size, sides[1].size];
        let lane = JumpLane {
            cell: [cell(0), cell(1)],
            throat: [sides[0].throat, sides[1].throat],
            to: self.throat,
            ducts: sizes,
            passing: sizes,
            references: self.references,
            walls: [R::ZERO; 2],
        };
        let f = acoustic(&lane, gas);
        let up = usize::from(f.mass < R::ZERO);
        let down = 1 - up;
        // The kinetic energy of the whole velocity in the place of that along the area.
        let counted = lane.cell[up].velocity[0];
        let velocity = self.states[up].velocity;
        let kinetic = R::HALF * (dot(velocity, velocity) - counted * counted);
        // The gas upstream, where it has come to the duct downstream.
        let narrowing = self.ducts[up] * self.states[up].density / (self.ducts[down] * self.states[down].density);
        let arrived = plus(sides[up].along, narrowing * sides[up].through, self.normal);
        let momentum = |s: usize| {
            let (side, own) = (&sides[s], self.states[s].velocity);
            let carried = if s == up { own } else { arrived };
            // Along the area the cell's own velocity, less what is counted.
            let change = dot(side.direction, own) - dot(side.direction, carried) - lane.cell[s].velocity[0];
            let momentum = carried.map(|u| f.mass * u);
            plus(momentum, f.mass * change + f.normal[s], side.direction)
        };
        let (energy, momentum) = (f.energy + f.mass * kinetic, [momentum(0), momentum(1)]);
        ObliqueFlux { mass: f.mass, energy, momentum, carried: f.carried }
    }
}
