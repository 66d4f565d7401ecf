//! Writes captures to a folder as they arrive.

use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

use serde::Serialize;

use super::manifest::{FrameLine, Header, MANIFEST, VERSION};
use crate::{
    error::CaptureError,
    source::{Captured, Image},
};
use files::{
    DepthCamera, FileError, crc32,
    depth_png::{FOLDER_CAMERA, write_camera, write_depths},
    disk, write_file, write_pcd,
};
use geometry::sixteen_numbers::SixteenNumbers;

/// Writes captures to a folder as they arrive. Nothing needs to be finished: the recording is complete after every frame.
#[derive(Debug)]
pub struct Recorder {
    folder: PathBuf,
    manifest: File,
    /// Length of the manifest's complete lines, bytes.
    length: u64,
    num_frames: u64,
    /// Size of all frames, bytes.
    num_bytes: u64,
    /// The camera in the folder's `intrinsics.json`.
    camera: Option<DepthCamera>,
}

impl Recorder {
    /// Begins a recording in a folder that is empty or does not exist. `title` describes the source for people, `source` is
    /// its specification.
    pub fn create(
        folder: &Path,
        title: &str,
        source: &str,
        is_simulated: bool,
    ) -> Result<Self, CaptureError> {
        let header = Header {
            partsight_recording: VERSION,
            title: title.to_owned(),
            source: source.to_owned(),
            simulated: is_simulated,
            started_at: geometry::clock::now(),
        };
        let begun = || -> io::Result<Option<Self>> {
            disk::create_dir_all(folder)?;
            if fs::read_dir(folder)?.next().is_some() {
                return Ok(None);
            }
            let mut recorder = Self {
                folder: folder.to_owned(),
                manifest: disk::open(
                    File::options().append(true).create_new(true),
                    &folder.join(MANIFEST),
                )?,
                length: 0,
                num_frames: 0,
                num_bytes: 0,
                camera: None,
            };
            recorder.append(&header)?;
            Ok(Some(recorder))
        };
        match begun() {
            Ok(Some(recorder)) => Ok(recorder),
            Ok(None) => Err(CaptureError::FolderInUse {
                path: folder.to_owned(),
            }),
            Err(source) => Err(CaptureError::Unwritable {
                path: folder.to_owned(),
                num_kept: 0,
                source,
            }),
        }
    }

    /// Number of frames written so far.
    pub fn num_frames(&self) -> u64 {
        self.num_frames
    }

    /// Size of the frames written so far, bytes.
    pub fn num_bytes(&self) -> u64 {
        self.num_bytes
    }

    /// Folder of the recording.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Writes a capture. On an error its frame is removed, and the frames before it are kept.
    pub fn write(&mut self, captured: &Captured) -> Result<(), CaptureError> {
        let (ending, camera) = match &captured.image {
            Image::Depth(frame) => ("png", Some(DepthCamera::from_frame(frame))),
            Image::Cloud(_) => ("pcd", None),
        };
        let file = format!("frame-{:06}.{ending}", self.num_frames + 1);
        let path = self.folder.join(&file);
        let written = self.write_frame(captured, camera, file);
        written.map_err(|source| {
            // An incomplete frame is useless; if it cannot be removed either, the manifest does not list it.
            let _ = disk::remove_file(&path);
            let _ = disk::remove_file(path.with_extension("json"));
            let _ = disk::set_len(&self.manifest, self.length);
            CaptureError::Unwritable {
                path,
                num_kept: self.num_frames,
                source,
            }
        })
    }

    fn write_frame(
        &mut self,
        captured: &Captured,
        camera: Option<DepthCamera>,
        file: String,
    ) -> io::Result<()> {
        let mut content = Vec::new();
        match &captured.image {
            Image::Depth(frame) => write_depths(&mut content, frame)?,
            Image::Cloud(cloud) => write_pcd(&mut content, cloud)?,
        }
        let path = self.folder.join(&file);
        if let Some(camera) = camera
            && self.camera != Some(camera)
        {
            // The first camera is stored for the whole folder; a frame of another camera has its own file beside it.
            let json = if self.camera.is_none() {
                self.folder.join(FOLDER_CAMERA)
            } else {
                path.with_extension("json")
            };
            write_camera(&json, &camera).map_err(|error| match error {
                FileError::Write { source, .. } => source,
                other => io::Error::other(other),
            })?;
            self.camera.get_or_insert(camera);
        }
        if path.exists() {
            // It failed before and could not be removed.
            disk::remove_file(&path)?;
        }
        write_file(&path, &content)?;
        self.append(&FrameLine {
            file,
            bytes: content.len() as u64,
            crc32: crc32(&content),
            taken_at: captured.taken_at,
            name: captured.name.clone(),
            simulated: captured.is_simulated,
            camera,
            truth: captured.truth.as_deref().cloned(),
            robot_from_flange: captured
                .robot_from_flange
                .as_deref()
                .copied()
                .map(SixteenNumbers),
        })?;
        self.num_frames += 1;
        self.num_bytes += content.len() as u64;
        Ok(())
    }

    fn append(&mut self, line: &impl Serialize) -> io::Result<()> {
        let mut text = serde_json::to_vec(line)?;
        text.push(b'\n');
        disk::write_all(&mut self.manifest, &text)?;
        disk::sync_data(&self.manifest)?;
        self.length += text.len() as u64;
        Ok(())
    }
}
