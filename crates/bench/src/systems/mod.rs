//! The left half of the paper's Table I: recognition time and rate, ours next to other systems.
//!
//! The paper compares its recogniser with four "major 3-D object detection systems" by time only, and names the others
//! only by numbers of its bibliography. So the other systems here are our own choice: the major descriptors of point
//! clouds, each with a nearest-neighbour search. Every system gets the same segmented part of the same simulated frame
//! and names one of the same references; none may refuse. The time is processor time for describing and matching the
//! part; it excludes segmentation, which all share, and preparing the references.

mod contestant;
mod paper_table;

use std::time::Duration;

use self::contestant::PreparedSystem;
pub use self::paper_table::{
    PAPER_COLUMNS, PAPER_MEAN_OF_OTHERS, PAPER_MEAN_OF_OWN, PAPER_SECONDS, paper_means,
};
use super::suites::{Suite, SuiteCase};
use inspection::{library::Library, pipeline::Recipe};
use stages::{
    descriptors::{local::LocalParams, surface::SurfaceError},
    reference::ReferenceError,
    scene::SceneCloud,
    segment::segment,
};

/// A recognition method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum System {
    /// The paper's recogniser.
    Paper,
    /// Our ranking by outline and overlap.
    Rank,
    /// Our ranking with confirmation of the best few by their poses: the default.
    Confirmed,
    /// Viewpoint feature histogram, nearest view.
    Vfh,
    /// Spin images.
    SpinImages,
    /// Fast point feature histograms.
    Fpfh,
    /// Signatures of histograms of orientations.
    Shot,
}

impl System {
    /// All systems, in the order of the table.
    pub const ALL: [Self; 7] = [
        Self::Paper,
        Self::Rank,
        Self::Confirmed,
        Self::Vfh,
        Self::SpinImages,
        Self::Fpfh,
        Self::Shot,
    ];

    /// Returns the name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Paper => "the paper's matcher",
            Self::Rank => "ours, ranking only",
            Self::Confirmed => "ours, with confirmation",
            Self::Vfh => "VFH",
            Self::SpinImages => "spin images",
            Self::Fpfh => "FPFH",
            Self::Shot => "SHOT",
        }
    }

    /// Returns the original publication.
    pub fn source(self) -> &'static str {
        match self {
            Self::Paper => "the paper, Algorithm 2",
            Self::Rank | Self::Confirmed => "Partsight",
            Self::Vfh => "Rusu et al. 2010",
            Self::SpinImages => "Johnson and Hebert 1999",
            Self::Fpfh => "Rusu et al. 2009",
            Self::Shot => "Tombari et al. 2010",
        }
    }

    /// Returns the parameters of a local descriptor; `None` for the other systems.
    fn local(self) -> Option<LocalParams> {
        match self {
            Self::SpinImages => Some(LocalParams::spin_images()),
            Self::Fpfh => Some(LocalParams::fpfh()),
            Self::Shot => Some(LocalParams::shot()),
            Self::Paper | Self::Rank | Self::Confirmed | Self::Vfh => None,
        }
    }
}

/// Result of one system on one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemOutcome {
    /// The reference named; `None` if the part could not be described.
    pub found: Option<String>,
    /// Time to describe the part and match it with all references.
    pub time: Duration,
    /// Size of the description; `None` for systems without a descriptor.
    pub size: Option<Size>,
}

/// Size of a description.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Size {
    /// Number of points of the thinned surface.
    pub num_points: usize,
    /// Number of descriptor rows.
    pub num_rows: usize,
}

/// Results of all systems on one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemsCase {
    /// Suite of the frame.
    pub suite: Suite,
    /// The right name.
    pub expected: String,
    /// Seed of the frame.
    pub seed: u64,
    /// Points of the segmented part; `None` if segmentation found none.
    pub num_points: Option<usize>,
    /// One outcome per [`System::ALL`]; empty without a part.
    pub answers: Vec<SystemOutcome>,
}

impl SystemsCase {
    /// Returns whether the system at this index of [`System::ALL`] named the part correctly.
    pub fn is_right(&self, system: usize) -> bool {
        let found = self.answers.get(system).and_then(|a| a.found.as_ref());
        found == Some(&self.expected)
    }
}

/// Preparation of the references for one system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Preparation {
    /// Time for all references together.
    pub time: Duration,
    /// Descriptor rows of all references together; `None` for ours and the paper's.
    pub num_rows: Option<usize>,
}

/// Why the systems could not be prepared.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, geometry::error::Advice)]
pub enum SystemsError {
    /// A reference cannot be described.
    #[error(transparent)]
    #[advice(transparent)]
    Surface(#[from] SurfaceError),
    /// A reference cannot be prepared.
    #[error(transparent)]
    #[advice(transparent)]
    Reference(#[from] ReferenceError),
}

/// All systems, prepared with the references of one library.
pub struct Systems<'a> {
    library: &'a Library,
    contestants: Vec<PreparedSystem>,
}

impl<'a> Systems<'a> {
    /// Prepares the references for each system.
    pub fn prepare(library: &'a Library) -> Result<Self, SystemsError> {
        let prepared = |system: &System| PreparedSystem::prepare(*system, library);
        Ok(Self {
            library,
            contestants: System::ALL.iter().map(prepared).collect::<Result<_, _>>()?,
        })
    }

    /// Returns the preparation of each of [`System::ALL`].
    pub fn preparations(&self) -> Vec<Preparation> {
        self.contestants.iter().map(|c| c.preparation).collect()
    }

    /// Runs each system on the scene of a suite's frame; `None` if no enrolled part hangs there.
    pub fn recognise(
        &self,
        suite: Suite,
        case: &SuiteCase,
        scene: &SceneCloud,
        recipe: &Recipe,
    ) -> Option<SystemsCase> {
        let part = segment(scene, &recipe.segment).part.ok();
        let answer = |contestant: &PreparedSystem| {
            let part = part.as_ref()?;
            Some(contestant.answer(part, scene, self.library, recipe))
        };
        Some(SystemsCase {
            suite,
            expected: case.expected.clone()?,
            seed: case.seed,
            num_points: part.as_ref().map(|p| p.cloud.points.len()),
            answers: self.contestants.iter().filter_map(answer).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_without_a_part_is_right_for_nobody() {
        let case = SystemsCase {
            suite: Suite::Placed,
            expected: "grille".into(),
            seed: 1,
            num_points: None,
            answers: Vec::new(),
        };
        assert!((0..System::ALL.len()).all(|system| !case.is_right(system)));
    }
}
