//! The meshes of a file: the list to choose from, and those that were chosen.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use image::RgbaImage;

use files::{MeshFile, NamedMesh, file_name, import::LengthUnit, in_counting_order};
use inspection::library::EnrolError;
use ui::{
    language::{text, what_and_advice},
    user_error::UserError,
};

/// Maximum number of pictures that are kept.
const MAX_PICTURES: usize = 200;

/// A file with several meshes, and what the list shows of each.
#[derive(Debug)]
pub struct MeshListing {
    /// The file.
    pub file: MeshFile,
    /// Its meshes, in the same order.
    pub meshes: Vec<ListedMesh>,
}

/// A mesh as the list shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedMesh {
    /// Its name.
    pub name: String,
    /// Width, height and depth, in the unit of the file.
    pub sides: [f64; 3],
    /// The longest of them.
    longest_side: f32,
    /// Number of triangles.
    pub num_triangles: usize,
    /// Why it cannot be enrolled, as far as that is known without trying.
    pub problem: Option<UserError>,
}

impl MeshListing {
    /// Measures the meshes of a file.
    pub fn of(file: MeshFile) -> Self {
        let meshes = file.meshes.iter().map(ListedMesh::of).collect();
        Self { file, meshes }
    }
}

impl ListedMesh {
    fn of(named: &NamedMesh) -> Self {
        let num_triangles = named.num_triangles();
        let problem = match &named.mesh {
            Err(error) => Some(UserError::of(error)),
            Ok(mesh) if mesh.area() > 0.0 => None,
            Ok(_) => {
                let no_area = EnrolError::NoArea { num_triangles };
                Some(what_and_advice(&no_area).into())
            }
        };
        Self {
            name: named.name.clone(),
            sides: named
                .size()
                .map_or([0.0; 3], |sides| sides.cast::<f64>().into()),
            longest_side: named.longest_side(),
            num_triangles,
            problem,
        }
    }
}

/// The small picture of a mesh, or why the mesh cannot be enrolled.
#[derive(Debug)]
pub struct MeshPicture {
    /// Index of the mesh in the file.
    pub index: usize,
    /// The picture.
    pub picture: Result<Arc<RgbaImage>, EnrolError>,
}

/// Order of the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeshOrder {
    /// By the longest side, longest first: body parts before screws.
    #[default]
    Size,
    /// By name.
    Name,
}

impl MeshOrder {
    /// Both, in the order of the buttons.
    pub const ALL: [Self; 2] = [Self::Size, Self::Name];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Size => text!("enrol-meshes-size"),
            Self::Name => text!("shell-name"),
        }
    }
}

/// Something that happened in the list. Rows are counted from 0, as they are shown.
#[derive(Debug)]
pub enum MeshAction {
    /// Show only meshes with these words in their names.
    Search(String),
    /// Sort the list.
    Order(MeshOrder),
    /// Read the lengths of the file in this unit.
    Unit(LengthUnit),
    /// Tick the mesh in this row, or remove its tick.
    Tick(usize),
    /// Tick all from the row reached last to this one.
    TickTo(usize),
    /// Go to this row by keys.
    GoTo(usize),
    /// These rows are visible.
    Visible(Range<usize>),
    /// Enrol the ticked meshes, and the one in this row, one after the other.
    Enrol(Option<usize>),
    /// Enrol the whole file as one part.
    EnrolWhole,
    /// Close the list.
    Close,
}

/// The list to choose from.
#[derive(Debug)]
pub struct MeshList {
    listing: Arc<MeshListing>,
    unit: LengthUnit,
    search: String,
    order: MeshOrder,
    /// Indices of all meshes in the order of the list.
    sorted: Vec<usize>,
    /// Those that the search finds.
    shown: Vec<usize>,
    ticked: BTreeSet<usize>,
    /// The row reached last.
    row: Option<usize>,
    /// Number of times that keys went to another row.
    num_moves: u64,
    visible: Range<usize>,
    pictures: BTreeMap<usize, Result<Arc<RgbaImage>, EnrolError>>,
}

impl MeshList {
    /// Makes the list of all meshes.
    pub fn new(listing: Arc<MeshListing>) -> Self {
        let mut list = Self {
            unit: listing.file.options.unit,
            search: String::new(),
            order: MeshOrder::default(),
            sorted: (0..listing.meshes.len()).collect(),
            shown: Vec::new(),
            ticked: BTreeSet::new(),
            row: None,
            num_moves: 0,
            visible: 0..0,
            pictures: BTreeMap::new(),
            listing,
        };
        list.sort();
        list
    }

    /// Name of the file.
    pub fn title(&self) -> String {
        file_name(&self.listing.file.file)
    }

    /// The file and what is known of its meshes.
    pub(super) fn listing(&self) -> &Arc<MeshListing> {
        &self.listing
    }

    /// The unit of the file's lengths.
    pub fn unit(&self) -> LengthUnit {
        self.unit
    }

    /// The words searched for.
    pub fn search(&self) -> &str {
        &self.search
    }

    /// The order of the list.
    pub fn order(&self) -> MeshOrder {
        self.order
    }

    /// Number of meshes that the search finds.
    pub fn num_shown(&self) -> usize {
        self.shown.len()
    }

    /// The row reached last, and how often keys went to another.
    pub(super) fn row_of_keys(&self) -> (Option<usize>, u64) {
        (self.row, self.num_moves)
    }

    /// The mesh in this row, with its index in the file.
    pub fn mesh(&self, row: usize) -> Option<(usize, &ListedMesh)> {
        let index = *self.shown.get(row)?;
        Some((index, self.listing.meshes.get(index)?))
    }

    /// True if the mesh is ticked.
    pub fn is_ticked(&self, index: usize) -> bool {
        self.ticked.contains(&index)
    }

    /// The picture of a mesh, once it is drawn.
    pub(super) fn picture(&self, index: usize) -> Option<&Arc<RgbaImage>> {
        self.pictures.get(&index)?.as_ref().ok()
    }

    /// Why a mesh cannot be enrolled, as far as that is known.
    pub fn problem(&self, index: usize) -> Option<UserError> {
        let listed = self.listing.meshes.get(index)?;
        listed.problem.clone().or_else(|| {
            let tried = self.pictures.get(&index)?;
            Some(what_and_advice(tried.as_ref().err()?).into())
        })
    }

    /// The row that Enter enrols: none if meshes are ticked.
    pub fn row_to_enrol(&self) -> Option<usize> {
        let lone = (self.shown.len() == 1).then_some(0);
        let row = self.row.or(lone).filter(|_| self.ticked.is_empty())?;
        let (index, _) = self.mesh(row)?;
        self.problem(index).is_none().then_some(row)
    }

    /// Number of meshes that Enter enrols.
    pub fn num_to_enrol(&self) -> usize {
        self.ticked.len() + usize::from(self.row_to_enrol().is_some())
    }

    /// The ticked meshes and the one in this row, in the order of the list.
    pub(super) fn chosen(&self, row: Option<usize>) -> Option<ChosenMesh> {
        let in_row = row.and_then(|row| self.shown.get(row));
        let is_chosen = |index: &&usize| self.ticked.contains(*index) || in_row == Some(*index);
        let chosen = self.sorted.iter().filter(is_chosen);
        let chosen = chosen.filter(|index| self.problem(**index).is_none());
        let chosen = chosen.filter_map(|index| {
            let name = &self.listing.meshes.get(*index)?.name;
            let path = self.listing.file.path_of(Some(name), self.unit);
            Some((name.clone(), path))
        });
        ChosenMesh::first_of(chosen.collect())
    }

    /// The path of the whole file.
    pub(super) fn whole(&self) -> PathBuf {
        self.listing.file.path_of(None, self.unit)
    }

    /// Changes the list.
    pub(super) fn apply(&mut self, action: MeshAction) {
        match action {
            MeshAction::Search(words) => {
                self.search = words;
                self.find();
            }
            MeshAction::Order(order) => {
                self.order = order;
                self.sort();
            }
            MeshAction::Unit(unit) => {
                self.unit = unit;
                // What is too large in metres may be a part in millimetres.
                self.pictures.clear();
            }
            MeshAction::Tick(row) => {
                self.row = Some(row);
                if let Some(index) = self.enrollable(row)
                    && !self.ticked.remove(&index)
                {
                    self.ticked.insert(index);
                }
            }
            MeshAction::TickTo(row) => {
                let from = self.row.replace(row).unwrap_or(row);
                let rows = from.min(row)..=from.max(row);
                let ticked: Vec<usize> = rows.filter_map(|row| self.enrollable(row)).collect();
                self.ticked.extend(ticked);
            }
            MeshAction::GoTo(row) => {
                self.row = Some(row);
                self.num_moves += 1;
            }
            MeshAction::Visible(rows) => self.visible = rows,
            MeshAction::Enrol(_) | MeshAction::EnrolWhole | MeshAction::Close => {}
        }
    }

    fn enrollable(&self, row: usize) -> Option<usize> {
        let index = *self.shown.get(row)?;
        self.problem(index).is_none().then_some(index)
    }

    /// Takes in a picture, or why a mesh cannot be enrolled.
    pub(super) fn receive(&mut self, drawn: MeshPicture) {
        let MeshPicture { index, picture } = drawn;
        if picture.is_err() {
            self.ticked.remove(&index);
        }
        self.pictures.insert(index, picture);
        if self.pictures.len() > MAX_PICTURES {
            let visible: BTreeSet<usize> = self.visible_meshes().collect();
            self.pictures
                .retain(|index, picture| picture.is_err() || visible.contains(index));
        }
    }

    /// The visible meshes without a picture.
    pub(super) fn without_picture(&self) -> Vec<usize> {
        let visible = self.visible_meshes();
        let unknown = visible.filter(|index| !self.pictures.contains_key(index));
        let unknown = unknown.filter(|index| self.problem(*index).is_none());
        unknown.collect()
    }

    fn visible_meshes(&self) -> impl Iterator<Item = usize> {
        let Range { start, end } = self.visible.clone();
        let rows = self.shown.iter().take(end).skip(start);
        rows.copied()
    }

    fn sort(&mut self) {
        let meshes = &self.listing.meshes;
        match self.order {
            MeshOrder::Size => self.sorted.sort_by(|a, b| {
                let [a, b] = [a, b].map(|index| meshes[*index].longest_side);
                b.total_cmp(&a)
            }),
            MeshOrder::Name => self
                .sorted
                .sort_by_cached_key(|index| in_counting_order(&meshes[*index].name.to_lowercase())),
        }
        self.find();
    }

    fn find(&mut self) {
        let words = self.search.to_lowercase();
        let words: Vec<&str> = words.split_whitespace().collect();
        let is_found = |index: &&usize| {
            let name = self.listing.meshes[**index].name.to_lowercase();
            words.iter().all(|word| name.contains(word))
        };
        self.shown = self.sorted.iter().filter(is_found).copied().collect();
        self.row = None;
    }
}

/// A mesh to enrol, among all that were chosen with it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChosenMesh {
    /// Name and path of each.
    all: Arc<[(String, PathBuf)]>,
    index: usize,
}

impl ChosenMesh {
    /// The first of these meshes.
    fn first_of(all: Vec<(String, PathBuf)>) -> Option<Self> {
        (!all.is_empty()).then(|| Self {
            all: all.into(),
            index: 0,
        })
    }

    /// The next one.
    pub fn following(&self) -> Option<Self> {
        let index = self.index + 1;
        (index < self.all.len()).then(|| Self {
            all: Arc::clone(&self.all),
            index,
        })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.all[self.index].0
    }

    /// The path that opens it.
    pub fn path(&self) -> &Path {
        &self.all[self.index].1
    }

    /// Its number, from 1, and that of all.
    pub fn number_of_all(&self) -> [usize; 2] {
        [self.index + 1, self.all.len()]
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;

    /// Lists squares with these sides, one of them after the other, of a file in millimetres.
    fn list(squares: &[(&str, f64)]) -> (MeshList, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("car.obj");
        let mut text = String::new();
        for (name, side) in squares {
            writeln!(
                text,
                "o {name}\nv 0 0 0\nv {side} 0 0\nv 0 {side} 0\nf -3 -2 -1"
            )
            .expect("written");
        }
        std::fs::write(&path, text).expect("written");
        let with_unit = PathBuf::from(format!("{}#units=mm", path.display()));
        let files::OpenedFile::Several(file) = files::open_each(&with_unit).expect("read") else {
            panic!("several");
        };
        (MeshList::new(Arc::new(MeshListing::of(file))), folder)
    }

    fn shown(list: &MeshList) -> Vec<&str> {
        let rows = (0..list.num_shown()).filter_map(|row| list.mesh(row));
        rows.map(|(_, mesh)| mesh.name.as_str()).collect()
    }

    fn blank() -> Arc<RgbaImage> {
        Arc::new(RgbaImage::new(1, 1))
    }

    fn names(mut chosen: Option<ChosenMesh>) -> Vec<String> {
        let mut names = Vec::new();
        while let Some(mesh) = chosen {
            names.push(mesh.name().to_owned());
            chosen = mesh.following();
        }
        names
    }

    #[test]
    fn the_largest_comes_first_and_names_are_sorted_as_people_count() {
        let (mut list, _folder) = list(&[("bolt_10", 8.0), ("Door", 900.0), ("bolt_9", 7.0)]);
        assert_eq!(shown(&list), ["Door", "bolt_10", "bolt_9"]);
        list.apply(MeshAction::Order(MeshOrder::Name));
        assert_eq!(shown(&list), ["bolt_9", "bolt_10", "Door"]);
        list.apply(MeshAction::Search(" 9 BOLT".into()));
        assert_eq!(shown(&list), ["bolt_9"]);
        list.apply(MeshAction::Search("wheel".into()));
        assert_eq!((list.num_shown(), list.num_to_enrol()), (0, 0));
    }

    #[test]
    fn ticks_outlast_a_search_and_are_enrolled_in_the_order_of_the_list() {
        let (mut list, _folder) = list(&[("A", 100.0), ("B", 900.0), ("C", 500.0), ("D", 700.0)]);
        // B, D, C, A.
        for row in [1, 3, 3, 0] {
            list.apply(MeshAction::Tick(row));
        }
        list.apply(MeshAction::Search("c".into()));
        assert_eq!((list.num_to_enrol(), list.row_to_enrol()), (2, None));
        assert_eq!(names(list.chosen(None)), ["B", "D"]);
        assert_eq!(names(list.chosen(Some(0))), ["B", "D", "C"]);
        list.apply(MeshAction::Search(String::new()));
        list.apply(MeshAction::Tick(1));
        list.apply(MeshAction::TickTo(3));
        assert_eq!(names(list.chosen(None)), ["B", "D", "C", "A"]);
        let second = list.chosen(None).and_then(|first| first.following());
        let second = second.expect("several");
        assert_eq!(second.number_of_all(), [2, 4]);
        assert!(second.path().ends_with("car.obj#D#units=mm"));
    }

    #[test]
    fn enter_takes_the_row_of_the_keys_or_the_only_one_found() {
        let (mut list, _folder) = list(&[("A", 100.0), ("B", 900.0)]);
        assert_eq!(list.row_to_enrol(), None);
        list.apply(MeshAction::GoTo(1));
        assert_eq!(names(list.chosen(list.row_to_enrol())), ["A"]);
        list.apply(MeshAction::Search("b".into()));
        assert_eq!(names(list.chosen(list.row_to_enrol())), ["B"]);
    }

    #[test]
    fn what_cannot_be_enrolled_is_not_chosen_until_another_unit_makes_it_a_part() {
        let (mut list, _folder) = list(&[("A", 100.0), ("Line", 0.0), ("B", 900.0)]);
        let [large, small, line] = [0, 1, 2].map(|row| list.mesh(row).expect("shown").0);
        let problem = list.problem(line).expect("a line has no area");
        assert!(!problem.what.is_empty() && !problem.advice.is_empty());
        list.apply(MeshAction::Visible(0..3));
        assert_eq!(list.without_picture(), [large, small]);
        list.apply(MeshAction::TickTo(0));
        list.apply(MeshAction::TickTo(2));
        let picture = Err(EnrolError::NoPartInScan { num_frames: 1 });
        list.receive(MeshPicture {
            index: large,
            picture,
        });
        list.receive(MeshPicture {
            index: small,
            picture: Ok(blank()),
        });
        assert_eq!(names(list.chosen(Some(0))), ["A"]);
        assert!(list.without_picture().is_empty());
        list.apply(MeshAction::Unit(LengthUnit::Inches));
        assert_eq!(list.without_picture(), [large, small]);
        list.apply(MeshAction::Tick(0));
        let chosen = list.chosen(None).expect("two");
        assert!(chosen.path().ends_with("car.obj#B#units=in"));
        assert!(list.whole().ends_with("car.obj#units=in"));
    }

    #[test]
    fn of_ten_thousand_meshes_few_pictures_are_kept() {
        let squares: Vec<(String, f64)> = (0..10_000)
            .map(|i| (format!("m{i}"), 1e5 - f64::from(i)))
            .collect();
        let squares: Vec<(&str, f64)> = squares
            .iter()
            .map(|(name, side)| (name.as_str(), *side))
            .collect();
        let (mut list, _folder) = list(&squares);
        assert_eq!(list.num_shown(), 10_000);
        for first in (0..600).step_by(10) {
            list.apply(MeshAction::Visible(first..first + 10));
            for index in list.without_picture() {
                let picture = Ok(blank());
                list.receive(MeshPicture { index, picture });
            }
            assert!(list.without_picture().is_empty(), "{first}");
            assert!(list.pictures.len() <= MAX_PICTURES);
        }
    }
}
