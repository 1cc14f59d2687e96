//! Things in groups that grow together.

/// Disjoint sets with path halving.
#[derive(Debug)]
pub struct Sets(Vec<usize>);

impl Sets {
    /// `n` sets of one element each.
    #[must_use]
    pub fn new(n: usize) -> Self {
        Sets((0..n).collect())
    }

    /// The representative of an element's set: its lowest element.
    pub fn find(&mut self, mut a: usize) -> usize {
        while self.0[a] != a {
            self.0[a] = self.0[self.0[a]];
            a = self.0[a];
        }
        a
    }

    /// Make two sets one.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high] = low;
    }

    /// The sets, each in ascending order, by their lowest elements.
    #[must_use]
    pub fn groups(mut self) -> Vec<Vec<usize>> {
        let mut at = vec![0; self.0.len()];
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for n in 0..self.0.len() {
            let lowest = self.find(n);
            if lowest == n {
                at[n] = groups.len();
                groups.push(Vec::new());
            }
            groups[at[lowest]].push(n);
        }
        groups
    }
}

/// Values in the order of their numbers, which are below `count`; those of one number in their own order.
pub fn by_number<T: Copy>(
    values: impl Iterator<Item = T> + Clone,
    count: usize,
    number: impl Fn(&T) -> usize,
) -> Vec<T> {
    let mut next = vec![0; count + 1];
    values.clone().for_each(|value| next[number(&value) + 1] += 1);
    (0..count).for_each(|n| next[n + 1] += next[n]);
    let Some(any) = values.clone().next() else { return Vec::new() };
    let mut sorted = vec![any; next[count]];
    values.for_each(|value| {
        let at = &mut next[number(&value)];
        sorted[*at] = value;
        *at += 1;
    });
    sorted
}
