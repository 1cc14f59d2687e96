//! Walls that are not aligned with the grid: streams along planes, a wedge, turned shock tubes, bow shocks before blunt bodies.

use super::line::{finite_positive, report_events};
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::Riemann;
use crate::euler::expression::number_after;
use crate::euler::space::{OpenFractions, disc, half_space, open_fractions};
use serde_json::Value;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Error, Gas, Primitive};

const CFL: f64 = 0.8;

/// Time steps of a stream along a wall.
const STEPS: usize = 30;

impl Case {
    /// A list of numbers.
    fn list(&self, path: &str) -> Result<Vec<f64>, Trouble> {
        let all = self.data.pointer(path).and_then(Value::as_array);
        let numbers = all.and_then(|all| all.iter().map(Value::as_f64).collect());
        numbers.ok_or_else(|| Trouble::Field(path.into()))
    }

    /// As many numbers as there are dimensions.
    fn vector<const D: usize>(&self, path: &str) -> Result<[f64; D], Trouble> {
        self.list(path)?.try_into().map_err(|_| Trouble::Field(path.into()))
    }

    /// A number that follows a word in the sentence that tells what passes.
    fn limit(&self, word: &str) -> Result<f64, Trouble> {
        number_after(self.pass(), word).ok_or_else(|| Trouble::Field(format!("/pass: {word}")))
    }
}

/// A flow at default settings in cells of one width.
fn flow<const D: usize>(
    n: [usize; D],
    width: f64,
    gamma: f64,
    boundaries: [[Boundary<f64, D>; 2]; D],
    open: &OpenFractions<D>,
) -> Result<Flow<f64, D>, Error> {
    let mut flow = Flow::uniform(n, [width; D], Gas::Ideal { gamma }, boundaries);
    flow.set_porosity(open.volume.clone(), open.faces.clone(), Treatment::default())?;
    Ok(flow)
}

/// A stream of density 1 and pressure 1.
fn stream<const D: usize>(velocity: [f64; D]) -> Primitive<f64, D> {
    Primitive { density: 1.0, velocity, pressure: 1.0 }
}

fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Streams along plane walls stay as they are.
pub(super) fn wall_stream(case: &Case) -> Outcome {
    match case.list("/cells")?.len() {
        2 => wall_stream_in::<2>(case),
        _ => wall_stream_in::<3>(case),
    }
}

fn wall_stream_in<const D: usize>(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let (gamma, width) = (case.gamma()?, case.number("/width")?);
    let n = case.vector::<D>("/cells")?.map(|n| n as usize);
    let (through, towards) = (case.vector::<D>("/through")?, case.vector::<D>("/towards")?);
    let limit = case.limit("<=")?;
    let mut most = (0.0, String::new());
    for (number, _) in case.data["normals"].as_array().into_iter().flatten().enumerate() {
        let normal = case.vector::<D>(&format!("/normals/{number}"))?;
        let aside = dot(towards, normal) / dot(normal, normal);
        let along: [f64; D] = std::array::from_fn(|d| towards[d] - aside * normal[d]);
        let open = open_fractions(n, [0.0; D], width, |low, high| half_space(normal, dot(normal, through), low, high));
        for mach in case.list("/mach")? {
            let speed = mach * gamma.sqrt();
            let velocity = along.map(|a| a * speed / dot(along, along).sqrt());
            let error = mach * change_of_stream(n, width, gamma, velocity, &open)?;
            if !(error <= most.0) {
                most = (error, format!("normal {normal:?}, Mach {mach}"));
            }
        }
    }
    v.say(most.1);
    v.at_most("error*Mach", most.0, limit);
    Ok(v)
}

/// The largest change of the pressure in dynamic pressures, or of the velocity in units of its size, of a stream after some steps.
fn change_of_stream<const D: usize>(
    n: [usize; D],
    width: f64,
    gamma: f64,
    velocity: [f64; D],
    open: &OpenFractions<D>,
) -> Result<f64, Error> {
    let w = stream(velocity);
    let mut flow = flow(n, width, gamma, [[Boundary::FarField(w); 2]; D], open)?;
    flow.fill(|_| w);
    for _ in 0..STEPS {
        flow.advance(CFL, f64::MAX)?;
    }
    let square = dot(velocity, velocity);
    let errors = (0..flow.len()).filter(|&c| open.volume[c] > 0.0).flat_map(|c| {
        let now = flow.get(c);
        let of_velocity = (0..D).map(|d| (now.velocity[d] - velocity[d]).abs() / square.sqrt());
        of_velocity.chain([(now.pressure - 1.0).abs() / (0.5 * square)]).collect::<Vec<_>>()
    });
    // What is no number is the largest of all.
    Ok(errors.fold(0.0, |most: f64, e| if e <= most { most } else { e }))
}

/// The weak shock angle in degrees that turns a stream by an angle, from the theta-beta-M relation (Anderson, *Modern Compressible Flow*, eq. 4.17), by
/// bisection from the Mach angle.
fn shock_angle(gamma: f64, degrees: f64, mach: f64) -> f64 {
    let turns = |b: f64| {
        let m_sq = mach * mach;
        (2.0 / b.tan() * (m_sq * b.sin().powi(2) - 1.0) / (m_sq * (gamma + (2.0 * b).cos()) + 2.0)).atan()
    };
    let (mut low, mut high) = ((1.0 / mach).asin(), 65f64.to_radians());
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if turns(middle) < degrees.to_radians() { low = middle } else { high = middle }
    }
    low.to_degrees()
}

/// A wedge from a quarter of the first axis on, in a stream: angle of the shock, and pressure of the cells that the latter half of the wall cuts.
pub(super) fn wedge(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let (gamma, mach, degrees) = (case.gamma()?, case.number("/mach")?, case.number("/degrees")?);
    let n = case.vector::<2>("/cells")?.map(|n| n as usize);
    let width = 2.0 / n[0] as f64;
    let (sin, cos) = degrees.to_radians().sin_cos();
    let open = open_fractions(n, [0.0; 2], width, |low, high| half_space([-sin, cos], -sin * 0.25, low, high));
    let far = stream([mach * gamma.sqrt(), 0.0]);
    let boundaries = [[Boundary::FarField(far), Boundary::ZeroGradient], [Boundary::Wall, Boundary::ZeroGradient]];
    let mut flow = flow(n, width, gamma, boundaries, &open)?;
    flow.fill(|_| far);
    flow.run(CFL, case.number("/t_end")?)?;
    v.holds("finite,positive", finite_positive(&flow));
    report_events(&mut v, &flow);
    let latter = n[0] / 2..n[0] - 4;
    let p = |i: usize, j: usize| flow.get(j * n[0] + i).pressure;
    // The height at which the pressure has half risen, column by column, and a line through the heights.
    let half = 0.5 * (1.0 + p(n[0] - 2, n[1] / 2));
    let height = |i: usize| {
        let j = (0..n[1] - 1).rev().find(|&j| p(i, j) > half).unwrap_or(0);
        width * (j as f64 + 0.5 + (p(i, j) - half) / (p(i, j) - p(i, j + 1)))
    };
    let points: Vec<[f64; 2]> = latter.clone().map(|i| [width * (i as f64 + 0.5), height(i)]).collect();
    let mean = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / points.len() as f64);
    let moment = |k: usize| points.iter().map(|p| (p[0] - mean[0]) * (p[k] - mean[k])).sum::<f64>();
    let (found, exact) = ((moment(1) / moment(0)).atan().to_degrees(), shock_angle(gamma, degrees, mach));
    v.note("angle", found);
    v.at_most("angle error", (found - exact).abs(), case.limit("shock angle within")?);
    // Behind an oblique shock the pressure is that behind a normal one of the Mach number across it.
    let across = mach * exact.to_radians().sin();
    let behind = 1.0 + 2.0 * gamma / (gamma + 1.0) * (across * across - 1.0);
    let cells = latter.flat_map(|i| (0..n[1]).map(move |j| (i, j)));
    let cut = cells.map(|(i, j)| (p(i, j) / behind, open.volume[j * n[0] + i])).filter(|c| c.1 > 0.0 && c.1 < 1.0);
    let (mut sum, mut volume, mut most) = (0.0, 0.0, 0.0);
    for (pressure, share) in cut {
        (sum, volume, most) = (sum + pressure * share, volume + share, f64::max(most, (pressure - 1.0).abs()));
    }
    v.at_most("mean wall pressure", (sum / volume - 1.0).abs(), case.limit("mean pressure at the wall within")?);
    v.at_most("wall pressure of a cell", most, case.limit("of any cell there within")?);
    Ok(v)
}

/// Mean error of the velocity of a shock tube that is turned by some degrees and lies between two walls, and by which share the velocity of any cell is
/// too high.
fn turned_tube_on(case: &Case, degrees: f64, n: usize) -> Result<[f64; 2], Trouble> {
    let (gamma, t) = (case.gamma()?, case.number("/t_end")?);
    let (left, right) = (case.state("/init/left")?, case.state("/init/right")?);
    let width = 1.0 / n as f64;
    let (sin, cos) = degrees.to_radians().sin_cos();
    let along = |x: [f64; 2]| cos * x[0] + sin * x[1];
    // The tube runs through the middle; its walls lie 0.1 from its axis.
    let (cells, middle) = ([n, n / 2], [0.5, 0.25]);
    let axis = cos * middle[1] - sin * middle[0];
    let open = open_fractions(cells, [0.0; 2], width, |low, high| {
        half_space([-sin, cos], axis - 0.1, low, high) + half_space([sin, -cos], -axis - 0.1, low, high)
    });
    let mut flow = flow(cells, width, gamma, [[Boundary::ZeroGradient; 2]; 2], &open)?;
    let from_middle = |x: [f64; 2]| along([x[0] - middle[0], x[1] - middle[1]]);
    flow.fill(|x| {
        let s = if from_middle(x) < 0.0 { left } else { right };
        Primitive { density: s.rho, velocity: [0.0; 2], pressure: s.p }
    });
    flow.run(CFL, t)?;
    let exact = Riemann::new(left, right, gamma);
    let (mut error, mut volume, mut fastest) = (0.0, 0.0, 0.0);
    for c in 0..flow.len() {
        let s = from_middle([c % n, c / n].map(|i| width * (i as f64 + 0.5)));
        if s.abs() < 0.35 && open.volume[c] > 0.0 {
            let u = along(flow.get(c).velocity);
            error += open.volume[c] * (u - exact.at(s / t).u).abs();
            volume += open.volume[c];
            fastest = f64::max(u, fastest);
        }
    }
    Ok([error / volume, fastest / exact.at(0.0).u - 1.0])
}

/// A shock tube turned to the grid, on two grids, beside one along the grid.
pub(super) fn turned_tube(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let [few, many] = case.vector::<2>("/N")?.map(|n| n as usize);
    let [straight, _] = turned_tube_on(case, 0.0, many)?;
    for degrees in case.list("/degrees")? {
        let [coarse, _] = turned_tube_on(case, degrees, few)?;
        let [turned, over] = turned_tube_on(case, degrees, many)?;
        v.at_most(&format!("L1(u) at {degrees}°"), turned, case.limit("L1(u) <=")?);
        v.at_most(
            "over that along the grid",
            turned / straight,
            case.limit("times that of the tube along the grid <=")?,
        );
        v.at_most("over that on the coarser grid", turned / coarse, case.limit("times that on the coarser grid <=")?);
        v.at_most("overshoot", over, case.limit("overshoot <=")?);
    }
    Ok(v)
}

/// Share of a box (flat along any axes but not all) that lies within 1 of the origin: discs, by the rule of Gauss with eight points in each of four parts.
fn ball(low: [f64; 3], high: [f64; 3]) -> f64 {
    const POINTS: [(f64, f64); 4] = [
        (0.183_434_642_495_65, 0.362_683_783_378_362),
        (0.525_532_409_916_329, 0.313_706_645_877_887),
        (0.796_666_477_413_627, 0.222_381_034_453_375),
        (0.960_289_856_497_536, 0.101_228_536_290_376),
    ];
    let section = |z: f64| {
        let radius_sq = 1.0 - z * z;
        if radius_sq > 0.0 { disc(radius_sq.sqrt(), [low[0], low[1]], [high[0], high[1]]) } else { 0.0 }
    };
    if low[2] == high[2] {
        return section(low[2]);
    }
    let part = (high[2] - low[2]) / 4.0;
    let middles = (0..4).map(|k| low[2] + part * (f64::from(k) + 0.5));
    let both = |z: f64, x: f64| section(z - 0.5 * part * x) + section(z + 0.5 * part * x);
    middles.map(|z| POINTS.iter().map(|&(x, w)| 0.5 * w * both(z, x)).sum::<f64>()).sum::<f64>() / 4.0
}

/// A body of radius 1 in a stream, its middle on the axis or the axes of symmetry: how far off its bow shock stands.
pub(super) fn bow_shock(case: &Case) -> Outcome {
    match case.text("/body") {
        "cylinder" => bow_shock_of(case, |low, high| disc(1.0, low, high)),
        "sphere" => bow_shock_of(case, ball),
        other => Err(Trouble::Field(format!("/body = {other}"))),
    }
}

/// Where the pressure along the axis has made half of the jump of a normal shock, between the middles of two cells: the mean of 20 times, and between
/// which limits it wanders.
fn bow_shock_of<const D: usize>(case: &Case, body: impl Fn([f64; D], [f64; D]) -> f64) -> Outcome {
    let mut v = Verdict::default();
    let (gamma, mach) = (case.gamma()?, case.number("/mach")?);
    let (per_radius, front, height) =
        (case.number("/cells_per_radius")?, case.number("/front")?, case.number("/height")?);
    let [from, to] = case.pair("/times")?;
    let width = 1.0 / per_radius;
    let cells = |length: f64| (length * per_radius).round() as usize;
    let n = std::array::from_fn(|d| cells(if d == 0 { 1.0 + front } else { height }));
    let origin = std::array::from_fn(|d| if d == 0 { -1.0 - front } else { 0.0 });
    let far = stream(std::array::from_fn(|d| if d == 0 { mach * gamma.sqrt() } else { 0.0 }));
    let sides = std::array::from_fn(|d| {
        [if d == 0 { Boundary::FarField(far) } else { Boundary::Wall }, Boundary::ZeroGradient]
    });
    let mut flow: Flow<f64, D> = flow(n, width, gamma, sides, &open_fractions(n, origin, width, body))?;
    flow.fill(|_| far);
    let half = 1.0 + gamma / (gamma + 1.0) * (mach * mach - 1.0);
    let (mut sum, mut least, mut most, count) = (0.0, f64::MAX, 0.0f64, 20);
    for k in 0..count {
        flow.run(CFL, from + (to - from) * f64::from(k + 1) / f64::from(count))?;
        let p = |i: usize| flow.get(i).pressure;
        let i = (1..n[0]).find(|&i| p(i) > half).unwrap_or(1);
        let now = front - width * (i as f64 + 0.5 - (p(i) - half) / (p(i) - p(i - 1)));
        (sum, least, most) = (sum + now, least.min(now), most.max(now));
    }
    v.holds("no floors", flow.total.floored == 0);
    let found = sum / f64::from(count);
    v.note("radii", found);
    v.at_most("error", (found - case.number("/exact/stand_off")?).abs(), case.limit("stand-off within")?);
    v.at_most("wanders by", most - least, case.limit("wanders by <=")?);
    Ok(v)
}
