//! Orders of elimination by nested dissection (George, Nested Dissection of a Regular Finite Element Mesh, 1973; general
//! graphs after George and Liu, 1978).

use glam::{DMat3, DVec3};

/// Sets of at most so many unknowns are not parted any more: with all neighbours of neighbours coupled, they are nearly
/// full.
const LEAF: usize = 40;

/// Distance of what is not reached.
const FAR: u32 = u32::MAX;

/// The neighbours of each unknown, one list behind the other: who is where on the mesh, not what the matrix couples.
#[derive(Clone, Debug)]
pub struct Graph {
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    places: Vec<DVec3>,
    reach: u32,
}

impl Graph {
    /// A graph of as many unknowns as there are places, with their neighbours; `reach` is the number of edges over which
    /// the matrix couples. Neighbours beyond the unknowns are left out.
    pub fn new<'a>(places: &[DVec3], lists: impl Iterator<Item = &'a [u32]>, reach: u32) -> Self {
        let unknowns = places.len();
        let (mut starts, mut neighbours) = (Vec::with_capacity(unknowns + 1), Vec::new());
        starts.push(0);
        for list in lists.take(unknowns) {
            neighbours.extend(list.iter().copied().filter(|other| (*other as usize) < unknowns));
            starts.push(neighbours.len() as u32);
        }
        starts.resize(unknowns + 1, neighbours.len() as u32);
        Self { starts, neighbours, places: places.to_vec(), reach }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.starts.len() - 1
    }

    fn neighbours(&self, unknown: u32) -> &[u32] {
        &self.neighbours[self.starts[unknown as usize] as usize..self.starts[unknown as usize + 1] as usize]
    }

    /// The unknowns in an order in which few entries fill in, the first to be eliminated first.
    ///
    /// A set is parted by a band as broad as the matrix reaches, half way between two unknowns that are far from each
    /// other along the graph; first come the halves, each by itself, then the band.
    pub fn order(&self) -> Vec<usize> {
        let unknowns = self.unknowns();
        let mut dissection = Dissection {
            graph: self,
            side: vec![Side::Outside; unknowns],
            distance: vec![FAR; unknowns],
            from_first: vec![0; unknowns],
            order: Vec::with_capacity(unknowns),
        };
        dissection.all((0..unknowns as u32).collect());
        dissection.order
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    /// In none of the sets at hand.
    Outside,
    Within,
    /// Nearer to the first end, or to the second.
    First,
    Second,
    Band,
}

struct Dissection<'a> {
    graph: &'a Graph,
    side: Vec<Side>,
    distance: Vec<u32>,
    from_first: Vec<u32>,
    order: Vec<usize>,
}

impl Dissection<'_> {
    /// Orders a set, each of its connected parts by itself. The sets get smaller by a quarter at least, so that this ends
    /// after few levels.
    fn all(&mut self, set: Vec<u32>) {
        if set.len() <= LEAF {
            self.order.extend(set.iter().map(|v| *v as usize));
            return;
        }
        set.iter().for_each(|v| self.side[*v as usize] = Side::Within);
        let mut parts = Vec::new();
        for start in &set {
            if self.distance[*start as usize] == FAR {
                parts.push(self.reached_from(*start));
            }
        }
        drop(set);
        parts.iter().flatten().for_each(|v| {
            self.side[*v as usize] = Side::Outside;
            self.distance[*v as usize] = FAR;
        });
        for part in parts {
            if part.len() <= LEAF {
                self.order.extend(part.iter().map(|v| *v as usize));
            } else {
                self.part(part);
            }
        }
    }

    /// Parts a connected set, the last of which is far from the first: half way between two far ends along the graph, or
    /// across its longest extent in space, whichever needs the smaller band. The first is better where vertices lie much
    /// closer in one direction than in the other, the second where ends are corners.
    fn part(&mut self, set: Vec<u32>) {
        let along = self.along_the_graph(&set);
        let across = self.across_the_extent(&set);
        let cuts = [along, across].map(|halves| {
            for (half, side) in halves.iter().zip([Side::First, Side::Second]) {
                half.iter().for_each(|v| self.side[*v as usize] = side);
            }
            let rims = [(0, Side::Second), (1, Side::First)].map(|(half, other)| self.rim(&halves[half], other));
            let rim = if rims[0].len() <= rims[1].len() { 0 } else { 1 };
            (halves, rims, rim)
        });
        let shortest = usize::from(cuts[1].1[cuts[1].2].len() < cuts[0].1[cuts[0].2].len());
        let [first, second] = cuts;
        let (halves, [on_first, on_second], rim) = if shortest == 0 { first } else { second };
        for (half, side) in halves.iter().zip([Side::First, Side::Second]) {
            half.iter().for_each(|v| self.side[*v as usize] = side);
        }
        let band = self.band(if rim == 0 { on_first } else { on_second });
        let halves = halves.map(|mut half| {
            half.retain(|v| self.side[*v as usize] != Side::Band);
            half.sort_unstable();
            half
        });
        set.iter().for_each(|v| self.side[*v as usize] = Side::Outside);
        drop(set);
        for half in halves {
            self.all(half);
        }
        self.order.extend(band.iter().map(|v| *v as usize));
    }

    fn along_the_graph(&mut self, set: &[u32]) -> [Vec<u32>; 2] {
        set.iter().for_each(|v| self.side[*v as usize] = Side::Within);
        let Some(&far) = set.last() else { return [Vec::new(), Vec::new()] };
        let reached = self.reached_from(far);
        let other = reached.last().copied().unwrap_or(far);
        for v in &reached {
            self.from_first[*v as usize] = self.distance[*v as usize];
            self.distance[*v as usize] = FAR;
        }
        self.reached_from(other);
        // Less on the side of the first end; 0 half way.
        let between = |v: u32| i64::from(self.from_first[v as usize]) - i64::from(self.distance[v as usize]);
        let mut keyed: Vec<(i64, u32)> = set.iter().map(|v| (between(*v), *v)).collect();
        set.iter().for_each(|v| self.distance[*v as usize] = FAR);
        let middle = keyed.len() / 2;
        let median = keyed.select_nth_unstable(middle).1.0;
        // A straight cut keeps those at the same distance together, where the halves stay halves.
        let below = keyed.iter().filter(|(key, _)| *key < median).count();
        let upto = keyed.iter().filter(|(key, _)| *key <= median).count();
        let (count, bound) = if middle - below <= upto - middle { (below, median) } else { (upto, median + 1) };
        if count.min(keyed.len() - count) * 4 >= keyed.len() {
            let (first, second) = keyed.iter().partition::<Vec<_>, _>(|(key, _)| *key < bound);
            return [first, second].map(|half| half.iter().map(|(_, v)| *v).collect());
        }
        [&keyed[..middle], &keyed[middle..]].map(|half| half.iter().map(|(_, v)| *v).collect())
    }

    fn across_the_extent(&self, set: &[u32]) -> [Vec<u32>; 2] {
        let place = |v: u32| self.graph.places[v as usize];
        let mean = set.iter().map(|v| place(*v)).sum::<DVec3>() / set.len() as f64;
        let moment = set
            .iter()
            .map(|v| place(*v) - mean)
            .fold(DMat3::ZERO, |sum, arm| sum + DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z));
        // The direction of the largest extent, near enough, by powers.
        let mut axis = DVec3::new(1.0, 0.9, 0.8);
        for _ in 0..20 {
            axis = (moment * axis).normalize_or(DVec3::X);
        }
        let mut keyed: Vec<(f64, u32)> = set.iter().map(|v| (place(*v).dot(axis), *v)).collect();
        let middle = keyed.len() / 2;
        keyed.select_nth_unstable_by(middle, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        [&keyed[..middle], &keyed[middle..]].map(|half| half.iter().map(|(_, v)| *v).collect())
    }

    /// All within the set that can be reached from `start`, the farthest last; distances are noted.
    fn reached_from(&mut self, start: u32) -> Vec<u32> {
        let mut reached = vec![start];
        self.distance[start as usize] = 0;
        let mut next = 0;
        while next < reached.len() {
            let v = reached[next];
            next += 1;
            for &other in self.graph.neighbours(v) {
                if self.side[other as usize] == Side::Within && self.distance[other as usize] == FAR {
                    self.distance[other as usize] = self.distance[v as usize] + 1;
                    reached.push(other);
                }
            }
        }
        reached
    }

    /// Those of a half with a neighbour in the other.
    fn rim(&self, half: &[u32], other: Side) -> Vec<u32> {
        let across = |v: &u32| self.graph.neighbours(*v).iter().any(|w| self.side[*w as usize] == other);
        half.iter().copied().filter(across).collect()
    }

    /// The rim of a side, made as broad as the matrix reaches; ascending.
    fn band(&mut self, rim: Vec<u32>) -> Vec<u32> {
        let Some(side) = rim.first().map(|v| self.side[*v as usize]) else { return rim };
        let mut band = rim;
        band.iter().for_each(|v| self.side[*v as usize] = Side::Band);
        let mut edge = 0;
        for _ in 1..self.graph.reach {
            let end = band.len();
            for at in edge..end {
                let v = band[at];
                for &other in self.graph.neighbours(v) {
                    if self.side[other as usize] == side {
                        self.side[other as usize] = Side::Band;
                        band.push(other);
                    }
                }
            }
            edge = end;
        }
        band.sort_unstable();
        band
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn is_permutation(order: &[usize]) -> bool {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        sorted.iter().enumerate().all(|(i, v)| i == *v)
    }

    /// A net of `wide` x `deep` unknowns joined to those beside, above and below.
    fn net(wide: u32, deep: u32, reach: u32) -> Graph {
        let places: Vec<DVec3> =
            (0..deep * wide).map(|i| DVec3::new((i % wide).into(), 0.0, (i / wide).into())).collect();
        let lists: Vec<Vec<u32>> = (0..deep * wide)
            .map(|i| {
                let (x, z) = (i % wide, i / wide);
                let beside = [(x > 0).then(|| i - 1), (x + 1 < wide).then(|| i + 1)];
                let above = [(z > 0).then(|| i - wide), (z + 1 < deep).then(|| i + wide)];
                beside.into_iter().chain(above).flatten().collect()
            })
            .collect();
        Graph::new(&places, lists.iter().map(Vec::as_slice), reach)
    }

    /// Entries that fill in when the unknowns are eliminated in this order: each joins all later ones it is joined to.
    fn fill(graph: &Graph, order: &[usize]) -> usize {
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(i, v)| place[*v] = i);
        let mut later: Vec<std::collections::BTreeSet<usize>> = order
            .iter()
            .map(|v| {
                graph.neighbours(*v as u32).iter().map(|w| place[*w as usize]).filter(|p| *p > place[*v]).collect()
            })
            .collect();
        for i in 0..later.len() {
            let joined = std::mem::take(&mut later[i]);
            if let Some(first) = joined.first() {
                later[*first].extend(joined.iter().skip(1));
            }
            later[i] = joined;
        }
        later.iter().map(std::collections::BTreeSet::len).sum()
    }

    #[test]
    fn a_net_fills_in_less_than_row_by_row() {
        let graph = net(60, 60, 1);
        let order = graph.order();
        assert!(is_permutation(&order));
        let rows: Vec<usize> = (0..graph.unknowns()).collect();
        let (dissected, by_row) = (fill(&graph, &order), fill(&graph, &rows));
        assert!(2 * dissected < by_row, "{dissected} beside {by_row}");
    }

    #[test]
    fn the_middle_comes_last() {
        let graph = net(400, 3, 2);
        let last = graph.order().pop().unwrap() as u32 % 400;
        assert!((150..250).contains(&last), "{last}");
    }

    #[test]
    fn stars_chains_parts_and_doubled_places_end() {
        let star: Vec<Vec<u32>> = (0..2000).map(|i| if i == 0 { (1..2000).collect() } else { vec![0] }).collect();
        let parts: Vec<Vec<u32>> = vec![Vec::new(); 2000];
        let full: Vec<Vec<u32>> = (0..200).map(|i| (0..200).filter(|j| *j != i).collect()).collect();
        for lists in [star, parts, full, Vec::new()] {
            for place in [DVec3::ZERO, DVec3::splat(1e200)] {
                let graph = Graph::new(&vec![place; lists.len()], lists.iter().map(Vec::as_slice), 4);
                assert!(is_permutation(&graph.order()));
            }
        }
    }

    proptest! {
        #[test]
        fn any_graph_is_ordered_whole(count in 0_u32..300, edges in proptest::collection::vec((0_u32..300, 0_u32..300), 0..900), reach in 0_u32..5) {
            let mut lists = vec![Vec::new(); count as usize];
            for (a, b) in edges.into_iter().filter(|(a, b)| a != b && (*a).max(*b) < count) {
                lists[a as usize].push(b);
                lists[b as usize].push(a);
            }
            let places: Vec<DVec3> = (0..count).map(|i| DVec3::new((i % 7).into(), (i % 11).into(), (i % 3).into())).collect();
            let graph = Graph::new(&places, lists.iter().map(Vec::as_slice), reach);
            let order = graph.order();
            prop_assert_eq!(order.len(), count as usize);
            prop_assert!(is_permutation(&order));
        }
    }
}
