//! The genetic algorithm of Algorithm 3, over six genes: three angles and three lengths.
//!
//! J. H. Holland, "Adaptation in Natural and Artificial Systems", University of Michigan Press, 1975, with real numbers
//! as genes. Parents are selected by tournament and blended gene by gene (L. J. Eshelman and J. D. Schaffer,
//! "Real-coded genetic algorithms and interval-schemata", Foundations of Genetic Algorithms 2, 1993). A child takes the
//! place of the parent that it is more like, and only if it is better (S. W. Mahfoud, "Crowding and preselection
//! revisited", Parallel Problem Solving from Nature 2, 1992). That is the elitism: no individual is ever lost to a worse
//! one, and several valleys are searched side by side until one proves deepest.
//!
//! Ours: the size of a mutation is drawn evenly over its orders of magnitude, so that one search both jumps and
//! settles; and an angle may jump by half a turn, because that far off ICP ends on parts that are nearly flat.

use std::{
    f64::consts::{PI, TAU},
    ops::ControlFlow,
};

use rand::RngExt as _;
use rand_pcg::Pcg64;

/// Three angles in radians, -π..π, then three lengths in metres.
pub(super) type Genes = [f64; 6];

/// The first three genes are angles.
const NUM_ANGLES: usize = 3;

/// Parameters of the genetic algorithm.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct GeneticParams {
    /// Individuals, 4..10 000. Raising it searches more valleys at once and takes time in proportion.
    pub population: usize,
    /// Generations, 1..10 000. Raising it settles better and takes time in proportion.
    pub generations: usize,
    /// Individuals that compete to become a parent, 1..100; at most the population. Raising it settles sooner and searches
    /// fewer valleys.
    pub tournament: usize,
    /// Share of children that blend two parents, 0..1; the others begin as a copy of one. Raising it searches more
    /// between the parents and a little beyond, and less around each.
    pub crossover_rate: f64,
    /// Chance of each gene to mutate, 0..1; one always does. Raising it makes steps along one gene alone rarer.
    pub mutation_rate: f64,
    /// Orders of magnitude between the largest mutation, which is the range, and the smallest, 0..6. Raising it settles
    /// more finely and jumps less often.
    pub mutation_decades: f64,
    /// Chance of a child to jump by half a turn in one angle, 0..1. Raising it leaves fewer children to settle.
    pub half_turn_rate: f64,
}

impl Default for GeneticParams {
    /// Tuned on the eight shipped parts from T1..T5 with twenty seeds: anything within a factor of two does.
    fn default() -> Self {
        Self {
            population: 80,
            generations: 30,
            tournament: 2,
            crossover_rate: 0.7,
            mutation_rate: 0.3,
            mutation_decades: 2.0,
            half_turn_rate: 0.05,
        }
    }
}

/// No search holds more individuals or generations than this, whatever its parameters ask for.
const MOST: usize = 10_000;
/// How far beyond its parents a child may lie, as a share of what is between them: the habitual quarter keeps a
/// population from shrinking before it has found anything.
const BEYOND: f64 = 0.25;

/// Genes and what they cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Individual {
    /// The genes.
    pub(super) genes: Genes,
    /// Their cost; may be infinite.
    pub(super) cost: f64,
}

/// Searches for the genes of least cost, each within `range` of zero either way; an angle may leave it by half turns.
///
/// The population begins with `first`, then evenly over the range. `cost` is given genes and a bound, and may answer
/// infinity as soon as it knows that the cost is above the bound. `after_generation` is shown the best so far, and may
/// end the search.
pub(super) fn minimise(
    first: &[Genes],
    range: &Genes,
    params: &GeneticParams,
    rng: &mut Pcg64,
    mut cost: impl FnMut(&Genes, f64) -> f64,
    mut after_generation: impl FnMut(&Individual) -> ControlFlow<()>,
) -> Individual {
    let mut breeder = Reproduction { rng, range, params };
    let mut population: Vec<Individual> = (0..params.population.clamp(4, MOST))
        .map(|i| {
            let genes = first.get(i).copied().unwrap_or_else(|| breeder.anywhere());
            let cost = cost(&genes, f64::INFINITY);
            Individual { genes, cost }
        })
        .collect();
    for _ in 0..params.generations.min(MOST) {
        for _ in 0..population.len() {
            let parents = [breeder.parent(&population), breeder.parent(&population)];
            let genes = breeder.child(parents.map(|i| &population[i].genes));
            let [a, b] = parents.map(|i| breeder.unlikeness(&population[i].genes, &genes));
            let rival = &mut population[parents[usize::from(b < a)]];
            let cost = cost(&genes, rival.cost);
            if cost < rival.cost {
                *rival = Individual { genes, cost };
            }
        }
        if after_generation(best(&population)).is_break() {
            break;
        }
    }
    *best(&population)
}

fn best(population: &[Individual]) -> &Individual {
    population
        .iter()
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .expect("a population is never empty")
}

/// Draws individuals, parents and children.
struct Reproduction<'a> {
    rng: &'a mut Pcg64,
    range: &'a Genes,
    params: &'a GeneticParams,
}

impl Reproduction<'_> {
    /// Evenly within the range.
    fn anywhere(&mut self) -> Genes {
        self.range.map(|range| range * self.either_way())
    }

    /// The best of a few drawn.
    fn parent(&mut self, population: &[Individual]) -> usize {
        let mut winner = self.rng.random_range(0..population.len());
        for _ in 1..self.params.tournament.min(population.len()) {
            let rival = self.rng.random_range(0..population.len());
            if population[rival].cost < population[winner].cost {
                winner = rival;
            }
        }
        winner
    }

    fn child(&mut self, [a, b]: [&Genes; 2]) -> Genes {
        let params = self.params;
        let mut child = *a;
        if self.rng.random::<f64>() < params.crossover_rate {
            for (i, gene) in child.iter_mut().enumerate() {
                let share = self.rng.random_range(-BEYOND..=1.0 + BEYOND);
                *gene += share * way(i, a[i], b[i]);
            }
        }
        let always = self.rng.random_range(0..child.len());
        for (i, gene) in child.iter_mut().enumerate() {
            if i == always || self.rng.random::<f64>() < params.mutation_rate {
                let size = 10.0_f64.powf(-params.mutation_decades * self.rng.random::<f64>());
                *gene += self.range[i] * size * self.either_way();
            }
        }
        if self.rng.random::<f64>() < params.half_turn_rate {
            child[self.rng.random_range(0..NUM_ANGLES)] += PI;
        }
        for (i, (gene, range)) in child.iter_mut().zip(self.range).enumerate() {
            *gene = if i < NUM_ANGLES {
                way(i, 0.0, *gene)
            } else {
                gene.max(-range).min(*range)
            };
        }
        child
    }

    /// Squared distance between genes, each in units of its range.
    fn unlikeness(&self, a: &Genes, b: &Genes) -> f64 {
        let apart = |i: usize| way(i, a[i], b[i]) / self.range[i].max(f64::MIN_POSITIVE);
        (0..a.len()).map(|i| apart(i).powi(2)).sum()
    }

    fn either_way(&mut self) -> f64 {
        self.rng.random_range(-1.0..=1.0)
    }
}

/// From one value of a gene to another; angles go the short way round.
fn way(gene: usize, from: f64, to: f64) -> f64 {
    let straight = to - from;
    if gene < NUM_ANGLES {
        straight - TAU * (straight / TAU).round()
    } else {
        straight
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;

    use super::*;

    const RANGE: Genes = [PI, PI, PI, 0.5, 0.5, 0.5];

    fn minimised(optimum: Genes, params: &GeneticParams, seed: u64) -> Individual {
        let cost = |genes: &Genes, _: f64| {
            let off = |i: usize| way(i, optimum[i], genes[i]) / RANGE[i];
            // A bowl with dents: each gene by itself has a dozen valleys, the one at the optimum is the deepest.
            (0..6)
                .map(|i| off(i).powi(2) + 0.02 * (1.0 - (6.0 * TAU * off(i)).cos()))
                .sum()
        };
        let mut rng = Pcg64::seed_from_u64(seed);
        minimise(&[], &RANGE, params, &mut rng, cost, |_| {
            ControlFlow::Continue(())
        })
    }

    #[test]
    fn the_deepest_of_many_valleys_is_found_also_where_an_angle_wraps_round() {
        let params = GeneticParams {
            generations: 200,
            ..GeneticParams::default()
        };
        for optimum in [
            [0.5, -0.4, 2.0, 0.1, -0.2, 0.3],
            [3.1, -3.1, 1.5, 0.45, 0.0, -0.45],
        ] {
            for seed in 0..5 {
                let found = minimised(optimum, &params, seed);
                for i in 0..6 {
                    let off = way(i, optimum[i], found.genes[i]).abs() / RANGE[i];
                    assert!(off < 0.02, "gene {i} of {found:?}, seed {seed}");
                }
            }
        }
    }

    #[test]
    fn the_best_never_gets_worse_and_the_search_ends_when_told() {
        let mut costs = Vec::new();
        let cost = |genes: &Genes, _: f64| genes.iter().map(|g| g * g).sum();
        let mut rng = Pcg64::seed_from_u64(3);
        let params = GeneticParams::default();
        let found = minimise(&[], &RANGE, &params, &mut rng, cost, |best| {
            costs.push(best.cost);
            if costs.len() == 12 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!(costs.len(), 12);
        assert_eq!(costs.last(), Some(&found.cost));
        assert!(costs.windows(2).all(|pair| pair[1] <= pair[0]), "{costs:?}");
        assert!(costs[11] < 0.1 * costs[0], "{costs:?}");
    }

    #[test]
    fn the_same_seed_gives_the_same_bits_and_another_seed_others() {
        let params = GeneticParams::default();
        let run = |seed| minimised([0.3; 6], &params, seed);
        assert_eq!(run(1), run(1));
        assert_ne!(run(1), run(2));
    }

    #[test]
    fn children_stay_within_the_range_of_their_lengths() {
        let mut farthest = 0.0_f64;
        let range = [0.1, 0.1, 0.1, 0.02, 0.02, 0.02];
        let mut rng = Pcg64::seed_from_u64(1);
        let towards_a_corner = |genes: &Genes, _: f64| {
            farthest = genes[3..].iter().fold(farthest, |f, g| f.max(g.abs()));
            -genes[3..].iter().sum::<f64>()
        };
        let params = GeneticParams::default();
        let found = minimise(&[], &range, &params, &mut rng, towards_a_corner, |_| {
            ControlFlow::Continue(())
        });
        assert!(farthest <= 0.02);
        assert!(found.cost < -0.059, "{found:?}");
    }

    #[test]
    fn odd_parameters_end_too() {
        for params in [
            GeneticParams {
                population: 0,
                tournament: 0,
                ..GeneticParams::default()
            },
            GeneticParams {
                population: 5,
                tournament: 1000,
                ..GeneticParams::default()
            },
            GeneticParams {
                generations: 0,
                ..GeneticParams::default()
            },
            GeneticParams {
                mutation_decades: 300.0,
                crossover_rate: 2.0,
                ..GeneticParams::default()
            },
        ] {
            let found = minimised([0.0; 6], &params, 1);
            assert!(found.cost.is_finite(), "{params:?}: {found:?}");
        }
    }
}
