//! The paper's own method where ours differs from it: Algorithm 2 compares signatures, and ICP (eq. 12 and 13) or ICP-GA
//! (Algorithm 3) estimates the pose. `rank` and `pose` choose between these and ours. The paper's other steps (eq. 1 to 6 and
//! 8 to 10) are the stages themselves.

mod genetic;
mod icp;
mod icp_ga;
mod matching;

pub use self::{
    genetic::GeneticParams,
    icp::IcpParams,
    icp_ga::IcpGaParams,
    matching::{LiteralReference, linear_correlation},
};
pub(crate) use self::{icp::icp, icp_ga::icp_ga};
