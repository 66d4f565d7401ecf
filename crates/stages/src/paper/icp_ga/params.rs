//! Parameters of Algorithm 3.

use crate::paper::{GeneticParams, IcpParams};
use geometry::units::Radians;

/// Parameters of ICP-GA.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct IcpGaParams {
    /// E below which Algorithm 3 stops, square metres, 0..1e-4; the paper's 1e-6 is 1 mm rms. Lowering it costs
    /// rounds, and below the noise of the clouds all of them.
    pub target_e_m2: f64,
    /// Each round's ICP. Raising its points or iterations slows every round: by experiment 400 points and 30 iterations
    /// are enough, as what they miss the next search finds. Its own target is 0, so that it settles.
    pub icp: IcpParams,
    /// The search around the best pose.
    pub vicinity: GeneticParams,
    /// Range of the search around the best pose, in rms distances of that pose, 1..10; as a turn, that length at the
    /// part's extent. Raising it finds what ICP left further off, and settles more coarsely.
    pub vicinity_range: f64,
    /// The search elsewhere.
    pub elsewhere: GeneticParams,
    /// Range of the angles elsewhere, 0..π. Less than π leaves out poses that a person knows to be impossible.
    pub turn_range: Radians,
    /// Range of the shifts elsewhere, as a share of the target's extent (its standard deviation along its longest axis),
    /// 0..2. Raising it finds smaller overlaps, and needs a larger population.
    pub shift_range: f64,
    /// Points of the source with which a pose is scored where millimetres matter, 20..1000. Raising it costs
    /// time in proportion.
    pub num_fine_points: usize,
    /// Points of the source that a pose is tried on elsewhere, 20..1000. Raising it costs time in proportion.
    pub num_coarse_points: usize,
    /// Most rounds of Algorithm 3, 1..1000. Each costs 5 to 40 ms.
    pub max_rounds: usize,
    /// Rounds in a row without progress after which there is none to be had, 1..100. Raising it finds hidden poses, and
    /// costs about 8 ms each where the target cannot be reached.
    pub patience: usize,
    /// Share by which E must fall for a round to count as progress, 0..1. Raising it gives up sooner.
    pub least_progress: f64,
    /// Seed of all that is drawn, 0..999 999.
    pub seed: u64,
}

impl Default for IcpGaParams {
    fn default() -> Self {
        Self {
            target_e_m2: 1e-6,
            icp: IcpParams {
                max_iterations: 30,
                target_e_m2: 0.0,
                max_source_points: 400,
                ..IcpParams::default()
            },
            vicinity: GeneticParams {
                population: 60,
                tournament: 3,
                crossover_rate: 0.9,
                half_turn_rate: 0.0,
                ..GeneticParams::default()
            },
            vicinity_range: 4.0,
            elsewhere: GeneticParams::default(),
            turn_range: Radians(std::f64::consts::PI),
            shift_range: 0.5,
            num_fine_points: 60,
            num_coarse_points: 100,
            max_rounds: 40,
            patience: 8,
            least_progress: 0.02,
            seed: 1,
        }
    }
}
