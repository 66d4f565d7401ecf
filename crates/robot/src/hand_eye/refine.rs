//! The refinement of X and Z together, by Levenberg and Marquardt, and the bounds of the result.
//!
//! The residual of a pair is E = Z⁻¹ G X B, which ideally is the identity: its turn and its shift, each divided by its
//! scatter. The scatter is estimated from the residuals if there are enough pairs. X and Z are changed on their right,
//! so a change of X is one in the camera frame.
//!
//! The outline of a part moves with the view, along the surface and in proportion to its turn, because the sides of nearer
//! edges come into sight and fewer readings are lost there. All captures share this error, so no residual shows it: X and
//! Z absorb it as depth. Its effect on X is added to the bounds.
//!
//! Sources: K. Levenberg, "A method for the solution of certain non-linear problems in least squares", Quarterly of
//! Applied Mathematics 2, 1944; D. W. Marquardt, SIAM Journal 11(2), 1963.

use nalgebra::{Isometry3, Matrix3, SMatrix, SVector, Translation3, UnitQuaternion, Vector3};

use super::{CalibrationBounds, Equation, HandEyeSolution, Target, rms};
use geometry::units::{Metres, Radians};

/// Turn and shift of X, then of Z.
type NewtonStep = SVector<f64, 12>;
type Information = SMatrix<f64, 12, 12>;
type Jacobian = SMatrix<f64, 6, 12>;

/// Rounds of weighting and refining; the weights settle within two.
const ROUNDS: usize = 4;
/// Most steps of one round.
const MAX_STEPS: usize = 50;
/// A step that reduces the sum of squares by less than this share is the last.
const SETTLED: f64 = 1e-12;
/// With fewer pairs the scatter of shifts and turns cannot be separated, and the common ratio is used.
const LEAST_TO_WEIGH: usize = 6;
/// The common ratio of the two scatters, metres per radian: a millimetre for a tenth of a degree.
const COMMON_LEVER_M_PER_RAD: f64 = 0.57;
/// Plausible ratios, metres per radian.
const LEVER_RANGE_M_PER_RAD: std::ops::RangeInclusive<f64> = 0.05..=5.0;
/// A direction is unconstrained if its eigenvalue of the information is below this share of the largest.
const HELD: f64 = 1e-10;

/// An outline moves with the view by less than this in 95 of 100 cases, metres for a whole unit of the surface's normal
/// across the view: measured on the eight simulated parts, without noise and with a Kinect's.
const OUTLINE_SHIFT_M: f64 = 0.0025;

/// The result of a refinement.
pub(super) struct Refined {
    pub(super) unknowns: HandEyeSolution,
    lever: f64,
}

/// Refines X and Z, beginning at `start`.
pub(super) fn refine(equations: &[Equation], start: HandEyeSolution) -> Refined {
    let mut unknowns = start;
    let mut lever = COMMON_LEVER_M_PER_RAD;
    for round in 0..ROUNDS {
        unknowns = settle(equations, unknowns, lever);
        if round + 1 < ROUNDS && equations.len() >= LEAST_TO_WEIGH {
            lever = lever_of(equations, &unknowns);
        }
    }
    Refined { unknowns, lever }
}

/// The ratio of the scatters of shift and turn, metres per radian.
fn lever_of(equations: &[Equation], unknowns: &HandEyeSolution) -> f64 {
    let off: Vec<_> = equations.iter().map(|e| e.off(unknowns)).collect();
    let rms = rms(&off);
    let lever = rms.shift.0 / rms.rotation.0;
    if lever.is_finite() {
        lever.clamp(*LEVER_RANGE_M_PER_RAD.start(), *LEVER_RANGE_M_PER_RAD.end())
    } else {
        COMMON_LEVER_M_PER_RAD
    }
}

fn settle(equations: &[Equation], mut unknowns: HandEyeSolution, lever: f64) -> HandEyeSolution {
    let mut damping = 1e-6;
    let mut sum_sq = sum_of_squares(equations, &unknowns, lever);
    for _ in 0..MAX_STEPS {
        let (information, pull) = normal_equations(equations, &unknowns, lever);
        let mut is_better = false;
        // Ten times more damping per try: twelve orders of magnitude lead from a full step to none.
        while damping < 1e6 {
            let mut damped = information;
            for i in 0..12 {
                damped[(i, i)] += damping * information[(i, i)].max(f64::MIN_POSITIVE);
            }
            let tried = damped
                .cholesky()
                .map(|factor| unknowns.changed(&factor.solve(&-pull)));
            let found = tried.map(|tried| (tried, sum_of_squares(equations, &tried, lever)));
            if let Some((tried, tried_sq)) = found.filter(|(_, sq)| *sq < sum_sq) {
                is_better = sum_sq - tried_sq > SETTLED * sum_sq;
                (unknowns, sum_sq) = (tried, tried_sq);
                damping = (damping * 0.1).max(1e-12);
                break;
            }
            damping *= 10.0;
        }
        if !is_better {
            break;
        }
    }
    unknowns
}

impl HandEyeSolution {
    fn changed(&self, step: &NewtonStep) -> Self {
        let change = |at: usize| -> Isometry3<f64> {
            let turn: Vector3<f64> = step.fixed_rows::<3>(at).into_owned();
            let shift: Vector3<f64> = step.fixed_rows::<3>(at + 3).into_owned();
            let turn = UnitQuaternion::from_scaled_axis(turn);
            Isometry3::from_parts(Translation3::from(shift), turn)
        };
        Self {
            mount_from_camera: self.mount_from_camera * change(0),
            anchor_from_target: self.anchor_from_target * change(6),
        }
    }
}

/// E, and the residual: its turn, then its shift divided by the lever.
fn residual(
    equation: &Equation,
    unknowns: &HandEyeSolution,
    lever: f64,
) -> (Isometry3<f64>, SVector<f64, 6>) {
    let seen = unknowns.mount_from_camera * equation.camera_from_target;
    let error = unknowns
        .anchor_from_target
        .inv_mul(&(equation.anchor_from_mount * seen));
    let turn = error.rotation.scaled_axis();
    let shift = error.translation.vector / lever;
    let residual = SVector::from_iterator(turn.iter().chain(shift.iter()).copied());
    (error, residual)
}

fn sum_of_squares(equations: &[Equation], unknowns: &HandEyeSolution, lever: f64) -> f64 {
    let residuals = equations.iter().map(|e| residual(e, unknowns, lever).1);
    residuals.map(|r| r.norm_squared()).sum()
}

/// `JᵀJ` and `Jᵀr`.
fn normal_equations(
    equations: &[Equation],
    unknowns: &HandEyeSolution,
    lever: f64,
) -> (Information, NewtonStep) {
    let mut information = Information::zeros();
    let mut pull = NewtonStep::zeros();
    for equation in equations {
        let (error, residual) = residual(equation, unknowns, lever);
        let jacobian = jacobian(equation, &error, lever);
        information += jacobian.transpose() * jacobian;
        pull += jacobian.transpose() * residual;
    }
    (information, pull)
}

/// The derivative of the residual by turn and shift of X and Z.
///
/// A change (φ, ρ) of X multiplies E on its right by B⁻¹(φ, ρ)B, one of Z on its left by its inverse. The turn's
/// logarithm is linearised about E's own turn.
fn jacobian(equation: &Equation, error: &Isometry3<f64>, lever: f64) -> Jacobian {
    let target_from_camera = equation
        .camera_from_target
        .rotation
        .inverse()
        .to_rotation_matrix();
    let turned = target_from_camera.into_inner();
    let seen = equation.camera_from_target.translation.vector;
    let error_rotation = error.rotation.to_rotation_matrix().into_inner();
    let half = error.rotation.scaled_axis().cross_matrix() * 0.5;
    let shift = error.translation.vector;

    let mut jacobian = Jacobian::zeros();
    let mut put = |row: usize, column: usize, block: Matrix3<f64>| {
        jacobian
            .fixed_view_mut::<3, 3>(row, column)
            .copy_from(&block);
    };
    put(0, 0, (Matrix3::identity() + half) * turned);
    // φ × t is -[t]× φ.
    put(
        3,
        0,
        -(error_rotation * turned * seen.cross_matrix()) / lever,
    );
    put(3, 3, error_rotation * turned / lever);
    put(0, 6, -(Matrix3::identity() - half));
    put(3, 6, shift.cross_matrix() / lever);
    put(3, 9, -Matrix3::identity() / lever);
    jacobian
}

impl Refined {
    /// Returns the bounds of the error of X, at the middle of the target positions.
    ///
    /// The covariance is that of least squares. Its scale comes from the residuals, so few pairs give wide bounds
    /// (quantile of F instead of the normal distribution).
    pub(super) fn bounds(&self, equations: &[Equation], target: Target) -> CalibrationBounds {
        let Self { unknowns, lever } = self;
        let num = equations.len() as f64;
        let freedom = 6.0 * num - 12.0;
        let (information, _) = normal_equations(equations, unknowns, *lever);
        let Some(covariance) = inverse(&information) else {
            return CalibrationBounds::FREE;
        };
        let scatter_sq = sum_of_squares(equations, unknowns, *lever) / freedom;
        let middle = equations
            .iter()
            .map(|e| e.camera_from_target.translation.vector)
            .sum::<Vector3<f64>>()
            / num;
        // A point m of the camera's frame is shifted by ρ + φ × m.
        let mut shift_of = SMatrix::<f64, 3, 6>::zeros();
        shift_of
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&-middle.cross_matrix());
        shift_of
            .fixed_view_mut::<3, 3>(0, 3)
            .copy_from(&Matrix3::identity());
        let of_x: SMatrix<f64, 6, 6> = covariance.fixed_view::<6, 6>(0, 0).into_owned();
        let turn: Matrix3<f64> = of_x.fixed_view::<3, 3>(0, 0).into_owned();
        let shift = shift_of * of_x * shift_of.transpose();
        let within_sq = 3.0 * quantile_of_f(freedom) * scatter_sq;
        let longest = |covariance: Matrix3<f64>| {
            let largest = covariance.symmetric_eigenvalues().max();
            (largest.max(0.0) * within_sq).sqrt()
        };
        let by_outline: SVector<f64, 6> = match target {
            Target::Marker => SVector::zeros(),
            Target::Part { normal } => {
                let pull = self.pull_of_outline(equations, &normal);
                (covariance * pull).fixed_rows::<6>(0) * OUTLINE_SHIFT_M
            }
        };
        let turned = by_outline.fixed_rows::<3>(0).norm();
        CalibrationBounds {
            shift: Metres(longest(shift).hypot((shift_of * by_outline).norm())),
            turn: Radians(longest(turn).hypot(turned)),
        }
    }

    /// `Jᵀr` of an outline that moves by a metre for a whole unit of the normal across the view.
    fn pull_of_outline(&self, equations: &[Equation], normal: &Vector3<f64>) -> NewtonStep {
        let Self { unknowns, lever } = self;
        let pulls = equations.iter().map(|equation| {
            let seen = &equation.camera_from_target;
            let ray = seen.rotation.inverse() * seen.translation.vector;
            let ray = ray.try_normalize(0.0).unwrap_or_default();
            // Away from the camera, whichever way the normal points.
            let along = normal.dot(&ray);
            let shift = (normal - ray * along) * along.signum();
            let (error, _) = residual(equation, unknowns, *lever);
            let mut moved = SVector::<f64, 6>::zeros();
            moved.fixed_rows_mut::<3>(3).copy_from(&(shift / *lever));
            jacobian(equation, &error, *lever).transpose() * moved
        });
        pulls.sum()
    }
}

impl CalibrationBounds {
    /// Unconstrained.
    const FREE: Self = Self {
        shift: Metres(f64::INFINITY),
        turn: Radians(f64::INFINITY),
    };
}

/// The covariance of all twelve parameters; `None` if one of them is unconstrained.
fn inverse(information: &Information) -> Option<Information> {
    let eigen = information.clone_owned().symmetric_eigen();
    let is_held = eigen.eigenvalues.min() > HELD * eigen.eigenvalues.max();
    is_held.then(|| {
        let inverted = SVector::from_iterator(eigen.eigenvalues.iter().map(|x| 1.0 / x));
        eigen.eigenvectors * Information::from_diagonal(&inverted) * eigen.eigenvectors.transpose()
    })
}

/// 95 % quantiles of the F distribution with 3 degrees of freedom over this many; the last one is that of χ² over
/// three.
const QUANTILES: [(f64, f64); 8] = [
    (6.0, 4.757),
    (12.0, 3.490),
    (18.0, 3.160),
    (24.0, 3.009),
    (36.0, 2.866),
    (60.0, 2.758),
    (120.0, 2.680),
    (f64::INFINITY, 2.605),
];

/// Interpolates the table linearly in the reciprocal of the freedom.
fn quantile_of_f(freedom: f64) -> f64 {
    let pair = QUANTILES.windows(2).find(|pair| freedom <= pair[1].0);
    let Some(&[(low, at_low), (high, at_high)]) = pair else {
        return QUANTILES[QUANTILES.len() - 1].1;
    };
    let share = (1.0 / low - 1.0 / freedom.max(low)) / (1.0 / low - 1.0 / high);
    at_low + share * (at_high - at_low)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(numbers: [f64; 6]) -> Isometry3<f64> {
        geometry::rigid::from_euler_zyx(numbers)
    }

    #[test]
    fn the_jacobian_agrees_with_finite_differences() {
        let equation = Equation {
            anchor_from_mount: pose([0.4, -0.8, 2.0, 0.5, -0.3, 1.1]),
            camera_from_target: pose([-0.3, 0.2, 1.0, 0.1, -0.2, 1.3]),
        };
        let x = pose([1.2, 0.1, -0.4, 0.05, 0.1, 0.2]);
        let near = pose([0.02, -0.01, 0.03, 0.004, -0.002, 0.006]);
        let unknowns = HandEyeSolution {
            mount_from_camera: x,
            anchor_from_target: equation.anchor_from_mount * x * equation.camera_from_target * near,
        };
        let lever = 0.4;
        let (error, _) = residual(&equation, &unknowns, lever);
        let found = jacobian(&equation, &error, lever);
        let h = 1e-6;
        for column in 0..12 {
            let at = |sign: f64| {
                let mut step = NewtonStep::zeros();
                step[column] = sign * h;
                residual(&equation, &unknowns.changed(&step), lever).1
            };
            let expected = (at(1.0) - at(-1.0)) / (2.0 * h);
            let off = (found.column(column) - expected).amax();
            // The neglected second order of the logarithm: 0.04 rad squared over twelve.
            assert!(off < 5e-4, "column {column}: {off}");
        }
    }

    #[test]
    fn quantiles_lie_between_those_of_the_table() {
        assert!((quantile_of_f(6.0) - 4.757).abs() < 1e-9);
        // Tables give F(3, 30) = 2.922, F(3, 90) = 2.706 and F(3, 240) = 2.642.
        assert!((quantile_of_f(30.0) - 2.922).abs() < 0.01);
        assert!((quantile_of_f(90.0) - 2.706).abs() < 0.01);
        assert!((quantile_of_f(240.0) - 2.642).abs() < 0.01);
    }
}
