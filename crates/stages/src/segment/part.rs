//! Selects the connected surface that is the part, and extracts its points.

use nalgebra::Point3;

use super::{
    Cluster, MIN_POINTS, NoPart, PointLabel, SegmentParams, Segmentation,
    clusters::{self, Link},
    label_readings,
    necks::{HALF_WIDTHS_PIXELS, Silhouette},
    noise_of_picture,
    stand::{Bars, Mask, remove_stand},
    strip,
};
use crate::scene::SceneCloud;
use geometry::{
    cloud::{PointCloud, is_finite},
    plane::Plane,
    principal::principal_axes,
    statistics::quantile,
    units::Metres,
};

/// The points of the part.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentedPart {
    /// The part's points, metres, camera space, unorganised, in the scene's order.
    pub cloud: PointCloud,
    /// Index of each point in the scene, ascending.
    pub indices: Vec<u32>,
    /// Indices in the scene, ascending, of points that touch the part but belong to a stand; not among its points.
    pub stand: Vec<u32>,
    /// Standard deviation of a point's depth at 1 m; it grows with depth².
    pub noise_at_1m: Metres,
    /// True if the part reaches the edge of the view, so that some of it may be missing.
    pub touches_edge: bool,
    /// True if the part is to be searched for as a piece regardless of its outline, which a clamp or a hole changes.
    pub is_piece: bool,
    /// Figures of the surface; `None` if the cloud holds only the part.
    pub surface: Option<Cluster>,
}

/// Reason why a surface is more likely background than a part.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(tag = "sign", rename_all = "snake_case")]
pub enum BackgroundSign {
    /// Other surfaces are in front of it.
    Behind {
        /// Share of its border to other surfaces along which those are nearer, 0..1.
        share: f64,
    },
    /// The view cuts it off on most sides.
    Cut {
        /// Number of sides of the view that it reaches.
        sides: usize,
    },
    /// It is large and as flat as a wall.
    Flat {
        /// Area, square metres.
        area: f64,
    },
}

impl texts::Described for BackgroundSign {
    fn message(&self) -> texts::Message {
        texts::Message::new("background-sign").with_fields(self)
    }
}

texts::display!(BackgroundSign);

/// Number of sides cut off from which a surface is as likely a wall.
const MOST_CUT: usize = 3;
/// Area from which a flat surface is as likely a wall, square metres.
const LARGE_M2: f64 = 0.4;
/// Maximum deviation of a flat surface from its plane, beyond the noise, metres (standard deviation): car body
/// sheets are curved by centimetres.
const FLAT_M: f64 = 0.003;

impl SegmentedPart {
    /// Returns the reason why the part is more likely background, if there is one.
    pub fn background_sign(&self) -> Option<BackgroundSign> {
        let surface = self.surface?;
        if surface.in_front < IN_FRONT {
            let share = 1.0 - surface.in_front;
            return Some(BackgroundSign::Behind { share });
        }
        if surface.sides_cut >= MOST_CUT {
            return Some(BackgroundSign::Cut {
                sides: surface.sides_cut,
            });
        }
        let area = surface.area;
        (area > LARGE_M2 && self.is_flat()).then_some(BackgroundSign::Flat { area })
    }

    fn is_flat(&self) -> bool {
        let points = self.cloud.points.iter().step_by(7);
        is_flat(points.map(|p| p.cast()), self.noise_at_1m)
    }

    /// Creates a part from a cloud that holds nothing else.
    pub fn whole(cloud: &PointCloud) -> Self {
        let indices: Vec<u32> = cloud.finite().map(|(i, _)| i as u32).collect();
        Self::of(cloud, indices, SegmentParams::default().noise_at_1m, false)
    }

    /// Selects the readings of a scene at the given indices, in any order.
    pub fn selected(scene: &SceneCloud, indices: &[u32], params: &SegmentParams) -> Self {
        let is_reading = |i: &u32| {
            let point = scene.cloud.points.get(*i as usize);
            point.is_some_and(is_finite)
        };
        let mut indices: Vec<u32> = indices.iter().copied().filter(is_reading).collect();
        indices.sort_unstable();
        indices.dedup();
        let noise = noise_of_picture(scene).unwrap_or(params.noise_at_1m);
        let surface = clusters::figures_of(scene, &indices, noise, params);
        Self {
            surface: Some(surface),
            ..Self::of(&scene.cloud, indices, noise, surface.touches_edge)
        }
    }

    /// Returns the same part in the mirrored scene.
    #[must_use]
    pub fn mirrored(&self, mirrored_scene: &SceneCloud) -> Self {
        let indices = match mirrored_scene.cloud.grid {
            Some(grid) => {
                let mut indices = Vec::with_capacity(self.indices.len());
                for (_, start, of_row) in grid.by_row(&self.indices) {
                    let ends = (2 * start + grid.width - 1) as u32;
                    indices.extend(of_row.iter().rev().map(|i| ends - i));
                }
                indices
            }
            None => self.indices.clone(),
        };
        Self::of(
            &mirrored_scene.cloud,
            indices,
            self.noise_at_1m,
            self.touches_edge,
        )
    }

    fn of(scene: &PointCloud, indices: Vec<u32>, noise_at_1m: Metres, touches_edge: bool) -> Self {
        let pick = |i: &u32| *i as usize;
        Self {
            cloud: PointCloud {
                points: indices.iter().map(|i| scene.points[pick(i)]).collect(),
                normals: scene
                    .normals
                    .as_ref()
                    .map(|all| indices.iter().map(|i| all[pick(i)]).collect()),
                colours: scene
                    .colours
                    .as_ref()
                    .map(|all| indices.iter().map(|i| all[pick(i)]).collect()),
                labels: None,
                grid: None,
                is_simulated: scene.is_simulated,
                surplus_bytes: scene.surplus_bytes,
            },
            indices,
            stand: Vec::new(),
            noise_at_1m,
            touches_edge,
            is_piece: false,
            surface: None,
        }
    }

    /// Creates a part from a connected surface, without the stand that touches it.
    fn of_surface(
        scene: &SceneCloud,
        members: Vec<u32>,
        surface: Cluster,
        noise_at_1m: Metres,
    ) -> Self {
        let divided = remove_stand(scene, members);
        Self::of_divided(scene, divided, surface, noise_at_1m)
    }

    /// Creates a part from its points and its stand's.
    fn of_divided(
        scene: &SceneCloud,
        (indices, stand): (Vec<u32>, Vec<u32>),
        surface: Cluster,
        noise_at_1m: Metres,
    ) -> Self {
        let touches_edge = clusters::touches_edge(scene, &indices);
        Self {
            stand,
            surface: Some(surface),
            ..Self::of(&scene.cloud, indices, noise_at_1m, touches_edge)
        }
    }

    /// Returns the lowest index among the part and its stand, which is the first index of its connected surface.
    fn first_of_surface(&self) -> Option<&u32> {
        self.indices
            .first()
            .into_iter()
            .chain(self.stand.first())
            .min()
    }
}

/// Returns the point indices of every connected surface of a scene without background, largest first.
pub fn pieces(scene: &SceneCloud, params: &SegmentParams) -> Vec<Vec<u32>> {
    let labels = label_readings(&scene.cloud.points);
    let found = clusters::connect(scene, &labels, params.noise_at_1m, params);
    found.into_iter().map(|members| members.indices).collect()
}

/// Minimum area of another surface, as a share of the largest.
const LEAST_SHARE: f64 = 0.1;

/// Returns up to `limit` surfaces other than the selected part, the likeliest first.
pub fn other_segments(
    scene: &SceneCloud,
    segmentation: &Segmentation,
    params: &SegmentParams,
    limit: usize,
) -> Vec<SegmentedPart> {
    let largest = segmentation.clusters.first().map_or(0.0, |c| c.area);
    let least = least_area(largest, params);
    let part = segmentation.part.as_ref().ok();
    let taken = part.and_then(SegmentedPart::first_of_surface);
    let is_candidate = |cluster: &&Cluster| is_of_a_size(cluster, least);
    if taken.is_some() && segmentation.clusters.iter().filter(is_candidate).count() < 2 {
        return Vec::new();
    }
    let others = segmentation.likely_surfaces(least);
    others
        .into_iter()
        .filter(|(_, indices)| indices.first() != taken)
        .take(limit)
        .map(|surface| segmentation.part_of(scene, surface))
        .collect()
}

fn is_of_a_size(cluster: &Cluster, least_area: f64) -> bool {
    cluster.area >= least_area && cluster.num_points >= MIN_POINTS
}

/// Least width and depth of a body, metres, and its least width as a share of its length: bars, hooks and strips of a wall are
/// narrower or flatter, and a stool is not. In 760 simulated and real frames it holds for a bar with hooks that crossed, and for
/// nothing else that is clutter.
const BODY_WIDTH_M: f64 = 0.25;
const BODY_DEPTH_M: f64 = 0.12;
const BODY_WIDTH_SHARE: f64 = 0.5;

/// True if a surface is a body that lies wholly in view: what is as small as clutter beside large parts, and is none.
fn is_body(scene: &SceneCloud, members: &clusters::Members) -> bool {
    let points = || {
        let points = members.indices.iter();
        points.map(|i| scene.cloud.points[*i as usize].cast::<f64>())
    };
    let axes = principal_axes(points().map(|p| (p, 1.0)));
    let Some(axes) = axes.filter(|_| !members.cluster.touches_edge) else {
        return false;
    };
    let [length, width, depth] = [0, 1, 2].map(|axis| {
        let along = || points().map(|p| axes.axes.column(axis).dot(&p.coords));
        // A few strays do not make it larger.
        let ends = [0.98, 0.02].map(|share| quantile(along(), share).unwrap_or(0.0));
        ends[0] - ends[1]
    });
    width >= BODY_WIDTH_M && depth >= BODY_DEPTH_M && width >= BODY_WIDTH_SHARE * length
}

/// Minimum area of another surface to be a part, square metres, where the largest one has this area.
fn least_area(largest: f64, params: &SegmentParams) -> f64 {
    params.min_part_area.max(LEAST_SHARE * largest)
}

impl Segmentation {
    /// The surfaces that may be a part and have at least this area, square metres; the likeliest first.
    fn likely_surfaces(&self, least_area: f64) -> Vec<(&Cluster, &Vec<u32>)> {
        let surfaces = self.clusters.iter().zip(&self.surfaces);
        let mut likely: Vec<(&Cluster, &Vec<u32>)> = surfaces
            .filter(|(cluster, _)| is_of_a_size(cluster, least_area))
            // The camera looks at the part, not at what is behind other things.
            .filter(|(cluster, _)| cluster.in_front >= IN_FRONT)
            .collect();
        likely.sort_by(|a, b| part_prior(b.0).total_cmp(&part_prior(a.0)));
        likely
    }

    fn part_of(&self, scene: &SceneCloud, surface: (&Cluster, &Vec<u32>)) -> SegmentedPart {
        let (cluster, members) = (*surface.0, surface.1.clone());
        SegmentedPart::of_surface(scene, members, cluster, self.noise_at_1m)
    }

    /// Returns the segmentation of what is left of a scene without the points at these indices, which are known to belong to
    /// something else, the largest of area `largest`, square metres. Its part is the likeliest surface left that is neither
    /// clutter nor a strip of background; `None` if there is none of a part's size.
    pub fn without(
        &self,
        scene: &SceneCloud,
        known: &[u32],
        largest: f64,
        params: &SegmentParams,
    ) -> Option<Self> {
        let mut labels = self.labels.clone();
        for label in &mut labels {
            if *label == PointLabel::Part {
                *label = PointLabel::Rest;
            }
        }
        let mut unknown = labels.clone();
        for &i in known {
            unknown[i as usize] = PointLabel::NoReading;
        }
        let left = clusters::connect(scene, &unknown, self.noise_at_1m, params);
        let least = least_area(largest, params);
        let (clusters, surfaces) = left
            .into_iter()
            .filter(|members| {
                let area = members.cluster.area;
                area >= least || area >= params.min_part_area && is_body(scene, members)
            })
            .filter(|members| {
                let (planes, noise) = (&self.planes, self.noise_at_1m);
                !strip::is_strip(scene, members, &unknown, planes, noise, params)
            })
            .map(|members| (members.cluster, members.indices))
            .unzip();
        let mut left = Self {
            labels,
            planes: self.planes.clone(),
            clusters,
            surfaces,
            noise_at_1m: self.noise_at_1m,
            part: Err(NoPart::OnlyBackground {
                planes: self.planes.len(),
                found: 0.0,
                needed: least,
                knows_cell: scene.empty_cell.is_some(),
            }),
        };
        let likeliest = *left.likely_surfaces(params.min_part_area).first()?;
        let part = left.part_of(scene, likeliest);
        left.take(part);
        Some(left)
    }
}

/// Minimum share of its border along which a surface is the nearer one; below it, the surface lies behind others.
const IN_FRONT: f64 = 0.5;

/// Minimum share of the part's points that removing its bars must take off.
const LEAST_ON_BARS: f64 = 0.05;

/// The part without the bars of itself and its stand, in each way that removes more than hardly any points: without all of them,
/// and without all but slats.
pub fn without_bars<'a>(
    scene: &'a SceneCloud,
    part: &'a SegmentedPart,
) -> impl Iterator<Item = SegmentedPart> + 'a {
    let mut surface = [&part.indices[..], &part.stand].concat();
    #[expect(
        clippy::stable_sort_primitive,
        reason = "the stable sort merges two ascending runs"
    )]
    surface.sort();
    let mask = Mask::of(scene, &surface);
    let least = part.indices.len() as f64 * LEAST_ON_BARS;
    let mut num_before = 0;
    let ways = [Bars::All, Bars::AllButSlats].into_iter();
    ways.filter_map(move |bars| {
        let (figures, mask) = part.surface.zip(mask.as_ref())?;
        let divided = mask.divided(&surface, bars)?;
        let num = divided.0.len();
        let num_taken = part.indices.len() as f64 - num as f64;
        // A stand without slats leaves the same surface twice.
        let is_new = num != std::mem::replace(&mut num_before, num);
        (is_new && num_taken > least && num >= MIN_POINTS)
            .then(|| SegmentedPart::of_divided(scene, divided, figures, part.noise_at_1m))
    })
}

/// Pieces of a surface that have this share of their points in common are the same.
const SAME_PIECE_SHARE: f64 = 0.97;

/// Splits a surface where it is narrow or joined only across pixels without a reading: at the narrowest places first, then
/// at wider ones, too. Gives each piece once, of each split the largest first; none if the surface stays in one piece,
/// or without a picture. Pieces smaller than a part are left out.
pub fn split(
    scene: &SceneCloud,
    part: &SegmentedPart,
    params: &SegmentParams,
) -> impl Iterator<Item = SegmentedPart> {
    let noise = part.noise_at_1m;
    let link = Link::new(scene, noise, params);
    let mut surface = [&part.indices[..], &part.stand].concat();
    surface.sort_unstable();
    let picture = scene
        .cloud
        .grid
        .map(|grid| Silhouette::new(scene, grid, surface, link));
    let no_other = vec![PointLabel::NoReading; scene.cloud.points.len()];
    let min_area = params.min_part_area;
    let mut known: Vec<Vec<u32>> = Vec::new();
    let splits = picture.into_iter().flat_map(|picture| {
        HALF_WIDTHS_PIXELS
            .into_iter()
            .map(move |half_width| picture.cut(half_width))
    });
    splits
        .flat_map(move |pieces| {
            if pieces.len() < 2 {
                return Vec::new();
            }
            let mut pieces = clusters::members_of(scene, &no_other, pieces, link);
            pieces.retain(|piece| {
                piece.cluster.area >= min_area && piece.indices.len() >= MIN_POINTS
            });
            if pieces.len() < 2 {
                pieces.clear();
            }
            pieces.retain(|piece| {
                let is_new = !known
                    .iter()
                    .any(|known| is_same_piece(known, &piece.indices));
                if is_new {
                    known.push(piece.indices.clone());
                }
                is_new
            });
            pieces
        })
        .map(move |piece| SegmentedPart::of_surface(scene, piece.indices, piece.cluster, noise))
}

/// True if two pieces, given by ascending indices, are nearly the same.
fn is_same_piece(a: &[u32], b: &[u32]) -> bool {
    let (small, large) = if a.len() < b.len() { (a, b) } else { (b, a) };
    let least = SAME_PIECE_SHARE * large.len() as f64;
    let is_common = |i: &&u32| large.binary_search(i).is_ok();
    small.len() as f64 >= least && small.iter().filter(is_common).count() as f64 >= least
}

/// Rates how likely a surface is the part: the more of the view it fills, the more likely, since the camera looks at the
/// part. A surface cut off by the view is more often a strip of floor or a neighbour, and one behind others is a wall.
fn part_prior(cluster: &Cluster) -> f64 {
    let in_front = (cluster.in_front / IN_FRONT).min(1.0).powi(2);
    cluster.num_points as f64 * in_front * if cluster.touches_edge { 0.4 } else { 1.0 }
}

/// Returns true if points lie on a plane, within the noise.
pub(super) fn is_flat(
    points: impl ExactSizeIterator<Item = Point3<f64>> + Clone,
    noise_at_1m: Metres,
) -> bool {
    let depth_sq = points.clone().map(|p| p.z.powi(2)).sum::<f64>();
    let noise = noise_at_1m.0 * depth_sq / points.len().max(1) as f64;
    let principal = principal_axes(points.map(|p| (p, 1.0)));
    principal.is_some_and(|principal| principal.variances[2].sqrt() < FLAT_M + noise)
}

pub(super) fn select_part(
    scene: &SceneCloud,
    clusters: &[clusters::Members],
    labels: &mut [PointLabel],
    planes: &[Plane],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> Result<SegmentedPart, NoPart> {
    let is_strip =
        |c: &&clusters::Members| strip::is_strip(scene, c, labels, planes, noise_at_1m, params);
    let largest = clusters
        .iter()
        .filter(|c| !is_strip(c))
        .max_by(|a, b| part_prior(&a.cluster).total_cmp(&part_prior(&b.cluster)));
    match largest {
        Some(largest)
            if largest.cluster.area >= params.min_part_area
                && largest.indices.len() >= MIN_POINTS =>
        {
            let (members, cluster) = (largest.indices.clone(), largest.cluster);
            let part = SegmentedPart::of_surface(scene, members, cluster, noise_at_1m);
            for &i in &part.indices {
                labels[i as usize] = PointLabel::Part;
            }
            Ok(part)
        }
        _ => Err(NoPart::OnlyBackground {
            knows_cell: scene.empty_cell.is_some(),
            planes: planes.len(),
            found: largest.map_or(0.0, |l| l.cluster.area),
            needed: params.min_part_area,
        }),
    }
}
