//! Files of labelled pairs of hulls, one JSON object a line, and how answers are scored against them.
//!
//! Keys read: `kind`, `f32` (every coordinate is exact in single precision), `a`, `b` (vertex lists), `intersect` ("interior", "touch" or
//! "disjoint"), `dist` and `scale` (largest component difference or length; the clear pairs are those with `dist / scale` above 1e-6).

use std::collections::BTreeMap;
use std::fmt;

use serde_json::Value;
use voidage_core::convex::exact::{self, Contact, Relation};
use voidage_core::convex::gjk::{self, Distance, Intersection, OverlapProof, Reason};
use voidage_core::convex::shape::Hull;
use voidage_core::number::real::{Real, Vector};

use crate::oracle;
use crate::random::Random;
use crate::recipe::{FAMILIES, Recipe};

/// One labelled pair.
#[derive(Clone, Debug)]
pub struct Case {
    /// The family it comes from.
    pub kind: String,
    /// Whether single precision holds every coordinate.
    pub f32: bool,
    /// Vertices of the first hull.
    pub a: Vec<[f64; 3]>,
    /// Vertices of the second hull.
    pub b: Vec<[f64; 3]>,
    /// The truth.
    pub contact: Contact,
    /// The true distance.
    pub distance: f64,
    /// Size of the pair.
    pub scale: f64,
}

/// Reads a whole file; the error names the line.
pub fn read(text: &str) -> Result<Vec<Case>, String> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(i, line)| case(line).map_err(|e| format!("line {}: {e}", i + 1))).collect()
}

fn case(line: &str) -> Result<Case, String> {
    let value: Value = serde_json::from_str(line).map_err(|e| e.to_string())?;
    let contact = match value["intersect"].as_str() {
        Some("interior") => Contact::Overlapping,
        Some("touch") => Contact::Touching,
        Some("disjoint") => Contact::Disjoint,
        other => return Err(format!("unknown label {other:?}")),
    };
    Ok(Case {
        kind: value["kind"].as_str().unwrap_or("?").to_string(),
        f32: value["f32"].as_bool().unwrap_or(false),
        a: points(&value["a"]).ok_or("no vertices a")?,
        b: points(&value["b"]).ok_or("no vertices b")?,
        contact,
        distance: value["dist"].as_f64().unwrap_or(0.0),
        scale: value["scale"].as_f64().unwrap_or(0.0),
    })
}

/// A list of points, if it is one.
pub fn points(value: &Value) -> Option<Vec<[f64; 3]>> {
    let point = |p: &Value| {
        let x = p.as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<_>>>()?;
        <[f64; 3]>::try_from(x).ok()
    };
    value.as_array()?.iter().map(point).collect()
}

/// Points in the precision of `V`.
pub fn vectors<V: Vector>(points: &[[f64; 3]]) -> Vec<V> {
    points.iter().map(|p| V::from_array(p.map(Real::from_f64))).collect()
}

/// What was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Pairs looked at.
    pub cases: u64,
    /// Answers that contradict the label, or that their own proof does not bear out.
    pub wrong: u64,
    /// Pairs that neither touch nor were decided.
    pub undecided: u64,
    /// Touching pairs that were not decided.
    pub touch_undecided: u64,
    /// Distances outside their stated bounds, or off by more than the tolerance on clear pairs.
    pub distance_failures: u64,
    /// Largest relative error of a distance on clear pairs.
    pub max_relative_error: f64,
    /// Pairs that the first stage left to the exact one.
    pub second_stage: u64,
}

impl Score {
    /// Nothing wrong, nothing off.
    pub fn is_clean(&self) -> bool {
        self.wrong == 0 && self.distance_failures == 0
    }

    /// Both counts together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Score {
            cases: self.cases + other.cases,
            wrong: self.wrong + other.wrong,
            undecided: self.undecided + other.undecided,
            touch_undecided: self.touch_undecided + other.touch_undecided,
            distance_failures: self.distance_failures + other.distance_failures,
            max_relative_error: self.max_relative_error.max(other.max_relative_error),
            second_stage: self.second_stage + other.second_stage,
        }
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Score { cases, wrong, undecided, touch_undecided, distance_failures, max_relative_error, .. } = self;
        write!(
            f,
            "cases {cases} wrong {wrong} undecided {undecided} touch-undecided {touch_undecided} \
             distance-failures {distance_failures} max-relative-error {max_relative_error:.3e}"
        )
    }
}

/// Distances of clear pairs must be this good, relatively: in single precision a few of its roundings.
pub fn distance_tolerance<V: Vector>() -> f64 {
    if V::Scalar::EPSILON.to_f64() < 1e-10 { 1e-9 } else { 1e-6 }
}

/// Scores one pair after scaling every coordinate by a power of two.
pub fn score<V: Vector>(case: &Case, factor: f64) -> Score {
    let scaled = |p: &[[f64; 3]]| vectors::<V>(&p.iter().map(|p| p.map(|x| x * factor)).collect::<Vec<_>>());
    let (a, b) = (scaled(&case.a), scaled(&case.b));
    let (a, b) = (Hull::new(&a), Hull::new(&b));
    let mut score = Score { cases: 1, ..Score::default() };

    // First stage, with proofs.
    let first = gjk::intersect(&a, &b, None);
    let sound = match first {
        Intersection::Apart { axis } => case.contact != Contact::Overlapping && gjk::separates(&a, &b, axis),
        Intersection::Overlapping { proof: OverlapProof::Inside(simplex) } => {
            let of = |vertices: &[V], points: &[V]| points.iter().all(|p| vertices.contains(p));
            case.contact == Contact::Overlapping
                && simplex.holds_origin(Real::ZERO)
                && of(a.vertices(), &simplex.a)
                && of(b.vertices(), &simplex.b)
        }
        Intersection::Overlapping { .. } => false,
        Intersection::Undecided { .. } => true,
    };
    if !sound {
        score.wrong = 1;
    }
    // Both stages, and the second one with its own proofs where the first gave up.
    let settled = exact::contact(&a, &b, None);
    match settled {
        Ok(contact) if contact == case.contact => {}
        Ok(_) => score.wrong = 1,
        Err(_) if case.contact == Contact::Touching => score.touch_undecided = 1,
        Err(_) => score.undecided = 1,
    }
    if let Intersection::Undecided { .. } = first {
        score.second_stage = 1;
        if !proved(&a, &b, case.contact) {
            score.wrong = 1;
        }
    }

    score.distance_failures = u64::from(!distances_hold(case, &a, &b, factor, &mut score.max_relative_error));
    score
}

/// Whether the distances of both stages are inside their bounds and, for clear pairs, near enough to the truth.
fn distances_hold<V: Vector>(case: &Case, a: &Hull<V>, b: &Hull<V>, factor: f64, largest_error: &mut f64) -> bool {
    let truth = case.distance * factor;
    let disjoint = case.contact == Contact::Disjoint;
    let clear = disjoint && case.distance > 1e-6 * case.scale;
    let double = V::Scalar::EPSILON.to_f64() < 1e-10;
    let step = (V::Scalar::MIN_POSITIVE * V::Scalar::EPSILON).to_f64();
    let within = |lower: f64, upper: f64| {
        // The label itself is rounded.
        let room = 4.0 * f64::EPSILON * truth + step;
        lower <= truth + room && (upper.is_infinite() || truth - room <= upper)
    };
    let mut near = |distance: f64| {
        // Nothing is nearer than a step of the subnormal numbers.
        let off = (distance - truth).abs();
        let error = if off <= step { 0.0 } else { (off - step) / truth };
        *largest_error = largest_error.max(error);
        error <= distance_tolerance::<V>()
    };
    let Ok(nearest) = exact::distance(a, b, None) else { return false };
    let exact_holds = (!clear || near(nearest.distance)) && (truth <= step || (nearest.distance > 0.0) == disjoint);
    let first_holds = match gjk::distance(a, b, None) {
        Distance::Separated { distance, lower, upper, .. } => {
            let [distance, lower, upper] = [distance, lower, upper].map(Real::to_f64);
            let inside = lower <= distance && distance <= upper && within(lower, upper);
            disjoint && inside && !(clear && double && !near(distance))
        }
        Distance::Overlapping { .. } => case.contact == Contact::Overlapping,
        // For hulls whose gap is below the rounding of their coordinates the first stage leaves the distance to the exact one.
        Distance::Undecided { lower, upper, reason } => {
            let beyond_range = matches!(reason, Reason::NotFinite | Reason::TooSmall);
            let largest = case.a.iter().chain(&case.b).flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
            let below_rounding = case.distance < 64.0 * f64::EPSILON * largest;
            within(lower.to_f64(), upper.to_f64()) && (!clear || !double || beyond_range || below_rounding)
        }
    };
    exact_holds && first_holds
}

/// Whether the exact stage says so too, and proves it.
pub fn proved<V: Vector>(a: &Hull<V>, b: &Hull<V>, contact: Contact) -> bool {
    use std::cmp::Ordering;
    let Ok(relation) = exact::relation(a, b, None) else { return false };
    let sound = match &relation {
        Relation::Disjoint(axis) => axis.gap(a, b) == Ok(Ordering::Greater),
        Relation::Touching(axis) => axis.gap(a, b) == Ok(Ordering::Equal),
        Relation::Overlapping(points) => points.holds(a, b) == Ok(true),
    };
    sound && relation.contact() == contact
}

impl Case {
    /// Whether all coordinates of the case, times a factor, are exact in the precision of `V`.
    pub fn scales_exactly<V: Vector>(&self, factor: f64) -> bool {
        let exact = |x: &f64| {
            let scaled = x * factor;
            let rounded = <V::Scalar as Real>::from_f64(scaled).to_f64();
            Real::is_finite(rounded) && rounded == scaled && rounded / factor == *x
        };
        self.a.iter().chain(&self.b).flatten().all(exact)
    }
}

/// Scores by kind the cases that are exact with all coordinates times a factor, a power of two.
pub fn by_kind<V: Vector>(cases: &[Case], factor: f64) -> BTreeMap<String, Score> {
    let mut kinds = BTreeMap::new();
    for case in cases.iter().filter(|case| factor == 1.0 || case.scales_exactly::<V>(factor)) {
        let sum: &mut Score = kinds.entry(case.kind.clone()).or_default();
        *sum = sum.and(score::<V>(case, factor));
    }
    kinds
}

/// Lines of a file like those read here, from random recipes and labelled by the oracle.
pub fn made(seed: u64, count: u64) -> Vec<Value> {
    let mut random = Random::new(seed);
    let mut case = |i: u64| {
        let family = FAMILIES[i as usize % FAMILIES.len()];
        let mut points = || {
            let count = 1 + random.below(6);
            (0..count).map(|_| std::array::from_fn(|_| random.below(9) as i8 - 4)).collect::<Vec<_>>()
        };
        let (a, b) = (points(), points());
        let shift = std::array::from_fn(|_| random.below(9) as i8 - 4);
        let recipe = Recipe { family, a, b, shift, ulps: random.below(7) as i8 - 3, exponent: 0 };
        let (a, b) = recipe.make();
        let label = match oracle::contact(&a, &b) {
            Contact::Disjoint => "disjoint",
            Contact::Touching => "touch",
            Contact::Overlapping => "interior",
        };
        let difference = |p: &[f64; 3], q: &[f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
        let scale = a.iter().flat_map(|p| b.iter().map(move |q| difference(p, q))).fold(0.0, f64::max);
        let single = a.iter().chain(&b).flatten().all(|&x| f64::from(x as f32) == x);
        let dist = oracle::distance(&a, &b);
        serde_json::json!({
            "id": i, "kind": format!("{family:?}"), "f32": single, "a": a, "b": b, "intersect": label, "dist": dist, "scale": scale,
        })
    };
    (0..count).map(&mut case).collect()
}
