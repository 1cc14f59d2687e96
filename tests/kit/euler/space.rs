//! Open fractions of cells and faces beside walls given by formula. Nothing here is shared with the library's own geometry.

/// Open fractions of a mesh of equal cells: volumes, and faces axis by axis, x fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenFractions<const D: usize> {
    /// `beta_v`.
    pub volume: Vec<f64>,
    /// `beta_x`, `beta_y`, `beta_z`.
    pub faces: [Vec<f64>; D],
}

/// The fractions that a solid leaves of `n` cells of a width, the first of which begins at `origin`. `solid` as in [`between_edges`].
pub fn open_fractions<const D: usize>(
    n: [usize; D],
    origin: [f64; D],
    width: f64,
    solid: impl Fn([f64; D], [f64; D]) -> f64,
) -> OpenFractions<D> {
    let edges = std::array::from_fn(|d| (0..=n[d]).map(|i| origin[d] + width * i as f64).collect());
    between_edges(&edges, solid)
}

/// The fractions that a solid leaves of cells between edges. `solid` gives its share of the box between two corners, which is flat for a face.
pub fn between_edges<const D: usize>(
    edges: &[Vec<f64>; D],
    solid: impl Fn([f64; D], [f64; D]) -> f64,
) -> OpenFractions<D> {
    let n = edges.each_ref().map(|e| e.len() - 1);
    let all = |size: [usize; D], flat: Option<usize>| {
        let one = |mut i: usize| {
            let at = size.map(|n| {
                let k = i % n;
                i /= n;
                k
            });
            let low: [f64; D] = std::array::from_fn(|d| edges[d][at[d]]);
            let high = std::array::from_fn(|d| if flat == Some(d) { low[d] } else { edges[d][at[d] + 1] });
            1.0 - solid(low, high).clamp(0.0, 1.0)
        };
        (0..size.iter().product()).map(one).collect()
    };
    let faces = std::array::from_fn(|d| all(std::array::from_fn(|a| n[a] + usize::from(a == d)), Some(d)));
    OpenFractions { volume: all(n, None), faces }
}

/// Share of a box (flat along any axes) that lies where normal · x < offset.
///
/// R. Scardovelli, S. Zaleski, J. Comput. Phys. 164 (2000) 228: an alternating sum over the corners.
pub fn half_space<const D: usize>(normal: [f64; D], offset: f64, low: [f64; D], high: [f64; D]) -> f64 {
    let mut rest = offset;
    let mut spans = Vec::new();
    for d in 0..D {
        rest -= (normal[d] * low[d]).min(normal[d] * high[d]);
        let span = (normal[d] * (high[d] - low[d])).abs();
        if span > 0.0 {
            spans.push(span);
        }
    }
    if rest <= 0.0 {
        return 0.0;
    }
    if rest >= spans.iter().sum() {
        return 1.0;
    }
    let k = spans.len() as i32;
    let corner = |set: usize| {
        let chosen = spans.iter().enumerate().filter(|(d, _)| set >> d & 1 == 1);
        let (count, sum) = chosen.fold((0, 0.0), |(count, sum), (_, span)| (count + 1, sum + span));
        [1.0, -1.0][count % 2] * (rest - sum).max(0.0).powi(k)
    };
    let sum: f64 = (0..1 << k).map(corner).sum();
    sum / ((1..=k).product::<i32>() as f64 * spans.iter().product::<f64>())
}

/// The share of a box (or of its face) between the planes normal · x = `from` and `to`.
pub fn layer<const D: usize>(normal: [f64; D], [from, to]: [f64; 2], low: [f64; D], high: [f64; D]) -> f64 {
    half_space(normal, to, low, high) - half_space(normal, from, low, high)
}

/// Share of a rectangle (flat along one axis, if any) that lies within `radius` of the origin.
pub fn disc(radius: f64, low: [f64; 2], high: [f64; 2]) -> f64 {
    let half_chord = |x: f64| (radius * radius - x * x).max(0.0).sqrt();
    let overlap = |x: f64| (high[1].min(half_chord(x)) - low[1].max(-half_chord(x))).max(0.0);
    if low[0] == high[0] {
        return overlap(low[0]) / (high[1] - low[1]);
    }
    if low[1] == high[1] {
        let c = half_chord(low[1]);
        return (high[0].min(c) - low[0].max(-c)).max(0.0) / (high[0] - low[0]);
    }
    // Between the kinks each side of the overlap is a side of the rectangle or the circle, whose antiderivative is known.
    let primitive = |x: f64| 0.5 * (x * half_chord(x) + radius * radius * (x / radius).clamp(-1.0, 1.0).asin());
    let mut kinks = vec![low[0], high[0], -radius, radius];
    kinks.extend([low[1], high[1]].iter().flat_map(|&y| [-half_chord(y), half_chord(y)]));
    kinks.retain(|x| (low[0]..=high[0]).contains(x));
    kinks.sort_by(f64::total_cmp);
    let piece = |a: f64, b: f64| {
        let middle = 0.5 * (a + b);
        let (c, chord) = (half_chord(middle), primitive(b) - primitive(a));
        if !(overlap(middle) > 0.0) {
            return 0.0;
        }
        let top = if c < high[1] { chord } else { high[1] * (b - a) };
        let bottom = if -c > low[1] { -chord } else { low[1] * (b - a) };
        top - bottom
    };
    let area: f64 = kinks.windows(2).map(|k| piece(k[0], k[1])).sum();
    area / ((high[0] - low[0]) * (high[1] - low[1]))
}
