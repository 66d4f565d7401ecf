//! A folder of clouds or depth images, with numbers in their names in numeric order.

use std::path::Path;

use super::replay::{Content, Frames, RecordedFrame};
use crate::{
    capture::{error::CaptureError, read::may_be_capture},
    files::{file_name, in_counting_order},
};

pub(super) fn frames(folder: &Path) -> Result<Frames, CaptureError> {
    let listed = || -> std::io::Result<Vec<_>> {
        let paths = std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
        paths.collect()
    };
    let mut paths = listed().map_err(|source| CaptureError::FolderUnreadable {
        path: folder.to_owned(),
        source,
    })?;
    paths.retain(|path| may_be_capture(path) && path.is_file());
    paths.sort_by_cached_key(|path| in_counting_order(&file_name(path)));
    let frames = paths.into_iter().map(|path| RecordedFrame {
        name: file_name(&path),
        path,
        taken_at: None,
        is_simulated: false,
        truth: None,
        robot_from_flange: None,
        content: Content::Any,
    });
    Ok(Frames {
        title: format!("Folder {}", file_name(folder)),
        is_simulated: false,
        in_order: frames.collect(),
        warnings: Vec::new(),
    })
}
