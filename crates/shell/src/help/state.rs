//! What Help shows, and what it says about this computer.

use std::path::PathBuf;

use ui::language::text;

/// The open Help.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Help {
    /// The page in front.
    pub page: HelpPage,
    /// What is searched for; the results take the place of the page. Empty: nothing.
    pub search: String,
    /// What the guide shows.
    pub place: GuidePlace,
    /// True once it was drawn.
    pub(super) is_drawn: bool,
}

impl Help {
    pub(super) fn is_searching(&self) -> bool {
        !self.search.trim().is_empty()
    }
}

/// A page of Help.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HelpPage {
    /// Keys and what they do.
    #[default]
    Shortcuts,
    /// The guide.
    Guide,
    /// Version, licences, graphics and folders.
    About,
    /// What a problem report holds.
    Report,
}

impl HelpPage {
    pub(super) const ALL: [Self; 4] = [Self::Shortcuts, Self::Guide, Self::About, Self::Report];

    pub(super) fn title(self) -> String {
        match self {
            Self::Shortcuts => text!("shell-shortcuts"),
            Self::Guide => text!("help-guide"),
            Self::About => text!("help-about"),
            Self::Report => text!("help-report"),
        }
    }
}

/// A place in the guide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GuidePlace {
    /// Index of the page.
    pub page: usize,
    /// Index of a block of that page.
    pub block: usize,
    /// True until the page was scrolled there.
    pub(super) is_new: bool,
}

/// What the window runs on, and where its files are.
#[derive(Clone, Debug, Default)]
pub struct Installation {
    /// The graphics adapter, or why there is none.
    pub graphics: String,
    /// File of the settings.
    pub settings: Option<PathBuf>,
    /// Folder of the history.
    pub history: Option<PathBuf>,
    /// Folder of kept cases.
    pub cases: Option<PathBuf>,
    /// Folder of the recipes.
    pub recipes: Option<PathBuf>,
}
