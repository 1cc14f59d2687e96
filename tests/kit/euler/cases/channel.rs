//! The paper's channel with a box.

use super::line::*;
use super::{Case, Outcome, Trouble, Verdict};
use crate::euler::expression::number_after;
use voidage::flow::{Flow, Treatment};
use voidage_core::flow::{Boundary, Gas, Primitive};

/// Porosity of a box in a channel, exact: open shares of cells and faces. A face in the plane of a side of the box is closed
/// where the box covers it.
fn box_porosity(n: [usize; 3], dims: [f64; 3], solid: [[f64; 3]; 2]) -> (Vec<f64>, [Vec<f64>; 3]) {
    let width: [f64; 3] = std::array::from_fn(|d| dims[d] / n[d] as f64);
    let overlap = |d: usize, i: usize| {
        let (a, b) = (i as f64 * width[d], (i + 1) as f64 * width[d]);
        ((b.min(solid[1][d]) - a.max(solid[0][d])) / width[d]).clamp(0.0, 1.0)
    };
    let covers = |d: usize, i: usize| {
        let x = i as f64 * width[d];
        let eps = 1e-9 * width[d];
        f64::from(u8::from(x >= solid[0][d] - eps && x <= solid[1][d] + eps))
    };
    let tidy = |x: f64| if x < 1e-12 { 0.0 } else { x };
    let mut volume = Vec::new();
    let mut faces: [Vec<f64>; 3] = Default::default();
    for k in 0..=n[2] {
        for j in 0..=n[1] {
            for i in 0..=n[0] {
                let at = [i, j, k];
                let below = |d: usize| at[d] < n[d];
                if (0..3).all(below) {
                    volume.push(tidy(1.0 - overlap(0, i) * overlap(1, j) * overlap(2, k)));
                }
                for d in 0..3 {
                    if (0..3).all(|a| a == d || below(a)) {
                        let mut solid = covers(d, at[d]);
                        for a in (0..3).filter(|&a| a != d) {
                            solid *= overlap(a, at[a]);
                        }
                        faces[d].push(tidy(1.0 - solid));
                    }
                }
            }
        }
    }
    (volume, faces)
}

struct Channel {
    flow: Flow<f64, 3>,
    deficit: f64,
    /// Mean drag of the box in the last two fifths of the run, as a coefficient with ½ρu² of the inflow and the box' side.
    drag: f64,
    /// Half of what the means of four parts of that time differ by.
    drag_spread: f64,
    /// Mean pressure behind the box, up to a quarter of its length, over that of the last cells of the channel, in ½ρu².
    base: f64,
    plane_spread: f64,
    balance: f64,
}

/// Runs the channel from uniform flow, or from the flow on a mesh of half as many cells along each axis.
fn run_channel(
    case: &Case,
    n: [usize; 3],
    (volume, faces): (Vec<f64>, [Vec<f64>; 3]),
    coarse: Option<&Flow<f64, 3>>,
) -> Result<Channel, Trouble> {
    let dims: [f64; 3] = [case.number("/dims/0")?, case.number("/dims/1")?, case.number("/dims/2")?];
    let solid = [
        [case.number("/box/0/0")?, case.number("/box/0/1")?, case.number("/box/0/2")?],
        [case.number("/box/1/0")?, case.number("/box/1/1")?, case.number("/box/1/2")?],
    ];
    let inlet = case.state("/inlet")?;
    let gamma = case.gamma().unwrap_or(1.4);
    let width: [f64; 3] = std::array::from_fn(|d| dims[d] / n[d] as f64);
    let state = inlet.primitive::<3>();
    let mut boundaries = [[Boundary::Wall; 2]; 3];
    boundaries[0] = [Boundary::Inlet(state), Boundary::FarField(state)];
    let mut flow = Flow::uniform(n, width, Gas::Ideal { gamma }, boundaries);
    flow.set_porosity(volume.clone(), faces.clone(), Treatment::default())?;
    for c in 0..flow.len() {
        let mut w = state;
        if let Some(coarse) = coarse {
            let at = [c % n[0] / 2, c / n[0] % n[1] / 2, c / n[0] / n[1] / 2];
            let m = coarse.cells();
            w = coarse.get((at[2] * m[1] + at[1]) * m[0] + at[0]);
        }
        if volume[c] < 1e-12 {
            w.velocity = [0.0; 3];
        }
        flow.set(c, &w);
    }
    if let Some(coarse) = coarse {
        flow.boundaries = coarse.boundaries;
    }
    // Gas passes the channel five times, or once more where it starts from the steady flow on half as many cells.
    let t_end = if coarse.is_some() { 1.0 } else { 5.0 } * dims[0] / inlet.u;
    let sound = (gamma * inlet.p / inlet.rho).sqrt();
    let crossing = dims[0] / sound;
    let balance = Balance::start(&flow);
    let mut window = Window::new(&flow, 0.6 * t_end, 0.1 * t_end);
    while flow.time < t_end {
        // No shortened last step: the discrete steady state depends (to second order) on dt.
        let dt = flow.advance(0.9, f64::MAX)?;
        let plane = n[1] * n[2];
        let mean = (0..plane).map(|r| flow.get(r * n[0]).velocity[0]).sum::<f64>() / plane as f64;
        flow.boundaries[0][0] = flow.boundaries[0][0].relaxed(0, mean, sound, dt / crossing);
        window.step(&flow, dt, solid, width);
    }
    let side: f64 = [1, 2].map(|d: usize| solid[1][d] - solid[0][d]).iter().product();
    let head = 0.5 * inlet.rho * inlet.u * inlet.u;
    let (drag, drag_spread, base) = window.found(head, side);
    let gap = balance.gap(&flow)[0];
    // Mass flux through each plane from one more step.
    let before: Vec<f64> = (0..flow.len()).map(|c| flow.get(c).density).collect();
    let entered = flow.total.inflow[0][0].density;
    let dt = flow.advance(0.9, f64::MAX)?;
    let through = (flow.total.inflow[0][0].density - entered) / dt;
    let mut sum = 0.0;
    let mut spread = 0.0f64;
    for i in 0..n[0] {
        for r in 0..n[1] * n[2] {
            let c = r * n[0] + i;
            sum += (flow.get(c).density - before[c]) * flow.open_volume(c) / dt;
        }
        spread = spread.max((sum / through).abs());
    }
    let deficit = 1.0 - mean_behind(&flow, solid, 1.0, width, |w| w.velocity[0]) / inlet.u;
    Ok(Channel { deficit, drag, drag_spread, base, plane_spread: spread, balance: gap, flow })
}

/// What is averaged over a time: the drag by the balance of momentum along the channel, and the pressure behind the box.
struct Window {
    begin: f64,
    part: f64,
    /// Time, momentum that has come in, and momentum in the channel at the beginning of each part.
    marks: Vec<[f64; 3]>,
    /// Sum over time of the pressure behind the box over that at the end of the channel, and the time.
    base: [f64; 2],
}

impl Window {
    fn new(flow: &Flow<f64, 3>, begin: f64, part: f64) -> Self {
        Window { begin: flow.time + begin, part, marks: Vec::new(), base: [0.0; 2] }
    }

    fn step(&mut self, flow: &Flow<f64, 3>, dt: f64, solid: [[f64; 3]; 2], width: [f64; 3]) {
        let next = self.begin + self.part * self.marks.len() as f64;
        if flow.time < self.begin {
            return;
        }
        if flow.time >= next - 1e-9 * self.part {
            let entered = flow.total.inflow[0].iter().map(|side| side.momentum[0]).sum();
            self.marks.push([flow.time, entered, flow.content().momentum[0]]);
        }
        let n = flow.cells();
        let rows = n[1] * n[2];
        let end = (0..rows).map(|r| flow.get(r * n[0] + n[0] - 1).pressure).sum::<f64>() / rows as f64;
        self.base[0] += dt * (mean_behind(flow, solid, 0.25, width, |w| w.pressure) - end);
        self.base[1] += dt;
    }

    /// Mean drag coefficient, half the spread of the parts' means, base pressure coefficient.
    fn found(&self, head: f64, side: f64) -> (f64, f64, f64) {
        let between = |a: &[f64; 3], b: &[f64; 3]| ((b[1] - a[1]) - (b[2] - a[2])) / (b[0] - a[0]) / (head * side);
        let parts: Vec<f64> = self.marks.windows(2).map(|m| between(&m[0], &m[1])).collect();
        let (low, high) = parts.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &d| (l.min(d), h.max(d)));
        let mean = self.marks.first().zip(self.marks.last()).map_or(f64::NAN, |(a, b)| between(a, b));
        (mean, 0.5 * (high - low), self.base[0] / self.base[1] / head)
    }
}

/// Mean of something over the space behind the box, so many box lengths long. The space is the same on every mesh; cells across its sides count
/// with their share.
fn mean_behind(
    flow: &Flow<f64, 3>,
    solid: [[f64; 3]; 2],
    lengths: f64,
    width: [f64; 3],
    of: impl Fn(&Primitive<f64, 3>) -> f64,
) -> f64 {
    let n = flow.cells();
    let mut shadow = solid;
    shadow[0][0] = solid[1][0];
    shadow[1][0] = solid[1][0] + lengths * (solid[1][0] - solid[0][0]);
    let share = |d: usize, i: usize| {
        let (a, b) = (i as f64 * width[d], (i + 1) as f64 * width[d]);
        (b.min(shadow[1][d]) - a.max(shadow[0][d])).max(0.0)
    };
    let reached = |d: usize| {
        let first = (shadow[0][d] / width[d]).floor() as usize;
        (first..n[d]).take_while(move |&i| i as f64 * width[d] < shadow[1][d])
    };
    let (mut sum, mut space) = (0.0, 0.0);
    for (k, j) in reached(2).flat_map(|k| reached(1).map(move |j| (k, j))) {
        for i in reached(0) {
            let part = share(0, i) * share(1, j) * share(2, k);
            if part > 0.0 {
                sum += part * of(&flow.get((k * n[1] + j) * n[0] + i));
                space += part;
            }
        }
    }
    sum / space
}

pub(super) fn channel(case: &Case) -> Outcome {
    let mut v = Verdict::default();
    let n: [usize; 3] =
        [case.number("/grid/0")? as usize, case.number("/grid/1")? as usize, case.number("/grid/2")? as usize];
    let dims: [f64; 3] = [case.number("/dims/0")?, case.number("/dims/1")?, case.number("/dims/2")?];
    let corner = |s: usize| -> Result<[f64; 3], Trouble> {
        Ok([
            case.number(&format!("/box/{s}/0"))?,
            case.number(&format!("/box/{s}/1"))?,
            case.number(&format!("/box/{s}/2"))?,
        ])
    };
    let solid = [corner(0)?, corner(1)?];
    let inlet = case.state("/inlet")?;
    // The table's porosity: low faces of the cells listed, 1 elsewhere.
    let mut volume = vec![1.0; n[0] * n[1] * n[2]];
    let mut faces: [Vec<f64>; 3] =
        std::array::from_fn(|d| vec![1.0; (0..3).map(|a| n[a] + usize::from(a == d)).product()]);
    let (ci, cj, ck) = (case.column("i")?, case.column("j")?, case.column("k")?);
    for row in 0..ci.len() {
        let (i, j, k) = (ci[row] as usize, cj[row] as usize, ck[row] as usize);
        if i < n[0] && j < n[1] && k < n[2] {
            volume[(k * n[1] + j) * n[0] + i] = case.column("beta_v")?[row];
        }
        if j < n[1] && k < n[2] {
            faces[0][(k * n[1] + j) * (n[0] + 1) + i] = case.column("beta_x_lo")?[row];
        }
        if i < n[0] && k < n[2] {
            faces[1][(k * (n[1] + 1) + j) * n[0] + i] = case.column("beta_y_lo")?[row];
        }
        if i < n[0] && j < n[1] {
            faces[2][(k * n[1] + j) * n[0] + i] = case.column("beta_z_lo")?[row];
        }
    }
    let main = run_channel(case, n, (volume.clone(), faces), None)?;
    let flow = &main.flow;
    v.holds("finite,positive", finite_positive(flow));
    report_events(&mut v, flow);
    let fast = (0..flow.len())
        .filter(|&c| volume[c] < 1e-12)
        .map(|c| flow.get(c).velocity.iter().fold(0.0f64, |m, x| m.max(x.abs())))
        .fold(0.0, f64::max);
    v.at_most("u in the box", fast, 0.0);
    v.at_most("mass balance", main.balance, number_after(case.pass(), "-dM/dt| <=").unwrap_or(1e-12));
    v.at_most(
        "plane flux spread",
        main.plane_spread,
        number_after(case.pass(), "equal to inflow within").unwrap_or(1e-6),
    );
    v.at_least("wake deficit", main.deficit, 0.05);
    // Mirror symmetry where box and grid are symmetric.
    for d in [1, 2] {
        // Only where the tabulated porosity is symmetric itself, not merely to its rounding.
        let uneven = (0..volume.len()).any(|c| {
            let mut at = [c % n[0], c / n[0] % n[1], c / n[0] / n[1]];
            at[d] = n[d] - 1 - at[d];
            volume[c] != volume[(at[2] * n[1] + at[1]) * n[0] + at[0]]
        });
        if (solid[0][d] + solid[1][d] - dims[d]).abs() > 1e-12 * dims[d] || uneven {
            continue;
        }
        let mut worst = 0.0f64;
        for c in 0..flow.len() {
            let mut at = [c % n[0], c / n[0] % n[1], c / n[0] / n[1]];
            at[d] = n[d] - 1 - at[d];
            let (a, b) = (flow.get(c), flow.get((at[2] * n[1] + at[1]) * n[0] + at[0]));
            worst = worst.max((a.density / b.density - 1.0).abs());
            for e in 0..3 {
                let sign = if e == d { -1.0 } else { 1.0 };
                worst = worst.max((a.velocity[e] - sign * b.velocity[e]).abs() / inlet.u);
            }
        }
        v.at_most(&format!("symmetry {}", ["x", "y", "z"][d]), worst, 1e-12);
    }
    if case.pass().contains("doubling") {
        // The deficit of an inviscid wake behind sharp edges has no limit, for its layers roll up ever finer, nor has the base pressure on grids that do
        // not meet the box; the mean drag settles. The case's grid is the middle one of three: first refinement, then doubling.
        let [half, double] = [n.map(|n| (n / 2).max(1)), n.map(|n| 2 * n)];
        let of = |m: [usize; 3], coarse| run_channel(case, m, box_porosity(m, dims, solid), coarse);
        let (first, last) = (of(half, None)?, of(double, Some(flow))?);
        for (m, c) in [(half, &first), (n, &main), (double, &last)] {
            let at = format!("{}x{}x{}", m[0], m[1], m[2]);
            v.note(&format!("deficit@{at}"), c.deficit);
            v.note(&format!("drag@{at}"), c.drag);
            v.note(&format!("+-@{at}"), c.drag_spread);
            v.note(&format!("base@{at}"), c.base);
        }
        v.holds("the drag settles", (last.drag - main.drag).abs() < (main.drag - first.drag).abs());
        v.at_most("uncertainty of the drag", last.drag_spread / last.drag, 0.05);
    }
    Ok(v)
}
