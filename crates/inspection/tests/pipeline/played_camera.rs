//! What the tests of every played camera read of it and check on it.

use std::time::{Duration, Instant};

use capture::{
    BackpressurePolicy, CameraErrorKind, CaptureError, Captured, DepthSource, Feed, FeedItem,
    Image, NextCapture, Recovery, SourceListing, SourceSpec, open,
};
use geometry::{depth_frame::DepthFrame, error::Advice as _};

/// Timeout longer than any step of a test, so that it ends only one that hangs.
pub(crate) const PATIENCE: Duration = Duration::from_mins(1);

/// The next capture; `None` at the end of a file.
pub(crate) fn next_capture(source: &mut dyn DepthSource) -> Result<Option<Captured>, CaptureError> {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        match source.next(Duration::from_millis(20))? {
            NextCapture::Captured(captured) => return Ok(Some(captured)),
            NextCapture::End => return Ok(None),
            NextCapture::NotYet => {}
            NextCapture::Skipped(skipped) => panic!("{skipped:?}"),
        }
    }
    panic!("nothing came");
}

pub(crate) fn next_frame(source: &mut dyn DepthSource) -> DepthFrame {
    let captured = next_capture(source).expect("no problem").expect("no end");
    frame_of(captured)
}

pub(crate) fn frame_of(captured: Captured) -> DepthFrame {
    match captured.image {
        Image::Depth(frame) => frame,
        Image::Cloud(_) => panic!("a camera gives depth images"),
    }
}

/// Checks a camera that is unplugged after two frames, each time that it is opened.
pub(crate) fn is_lost_and_found_again(spec: SourceSpec) {
    let mut camera = open(&spec).expect("opens");
    let error = loop {
        match next_capture(camera.as_mut()) {
            Ok(captured) => assert!(captured.expect("no end").number <= 2),
            Err(error) => break error,
        }
    };
    assert_eq!(error.recovery(), Recovery::Reopen);
    assert!(error.to_string().contains("was lost"), "{error}");
    assert!(matches!(camera.next(Duration::ZERO), Ok(NextCapture::End)));
    drop(camera);

    let feed = Feed::start(spec, BackpressurePolicy::Every, || {}).expect("a thread");
    for _ in 0..4 {
        let item = feed.wait(PATIENCE).expect("a frame");
        assert!(matches!(item, FeedItem::Captured(_)), "{item:?}");
    }
}

/// Checks message and advice of a camera that does not open, or stops after its first frames.
pub(crate) fn is_refused(spec: &SourceSpec, words: &str, advice: &str) {
    // The second attempt is like the first: nothing is left behind that would keep the camera from opening.
    for _ in 0..2 {
        let ended = open(spec).and_then(|mut camera| {
            while next_capture(camera.as_mut())?.is_some() {}
            Ok(())
        });
        let error = ended.expect_err("refused");
        assert!(error.to_string().contains(words), "{error}");
        assert!(!error.to_string().contains('\n'), "{error}");
        assert!(error.advice().contains(advice), "{}", error.advice());
    }
}

/// Checks what the system's own library lists: cameras, that none is plugged in, or that it is not installed, with advice that has
/// these words. Returns whether it is installed.
#[expect(
    clippy::print_stdout,
    reason = "what a machine lists is a figure of its test"
)]
pub(crate) fn is_listed(listed: Vec<SourceListing>, words: &[&str]) -> bool {
    assert!(!listed.is_empty());
    let mut is_installed = true;
    for camera in listed {
        assert_eq!(camera.spec.is_some(), camera.error.is_none());
        let Some(error) = camera.error else {
            continue;
        };
        println!("figures: {}: {error}. {}", camera.title, error.advice());
        match error.kind {
            CameraErrorKind::LibraryMissing { path: None } => {
                is_installed = false;
                for word in words {
                    assert!(error.advice().contains(word), "{}", error.advice());
                }
            }
            // The error of a machine without a camera.
            CameraErrorKind::NoDevice { wanted: None, .. } => {}
            kind => panic!("{kind:?}"),
        }
    }
    is_installed
}
