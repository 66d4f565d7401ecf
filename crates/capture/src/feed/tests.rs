use std::{
    collections::VecDeque,
    sync::atomic::{AtomicUsize, Ordering},
    time::Instant,
};

use jiff::Timestamp;

use super::*;
use files::FileError;

/// Long enough for a busy machine; normally what is waited for comes at once.
const PATIENCE: Duration = Duration::from_mins(1);

fn captured(number: u64) -> Captured {
    crate::fixtures::captured(number, Timestamp::UNIX_EPOCH)
}

fn gone() -> CaptureError {
    CaptureError::FolderGone {
        path: "share".into(),
        may_come: true,
    }
}

fn hopeless() -> CaptureError {
    CaptureError::MeshIsNoCapture {
        path: "part.stl".into(),
    }
}

/// Delivers the given steps, then nothing more, or the end.
struct Script {
    steps: VecDeque<Result<NextCapture, CaptureError>>,
    open: Arc<AtomicUsize>,
}

impl Script {
    fn boxed(
        steps: impl IntoIterator<Item = Result<NextCapture, CaptureError>>,
        open: &Arc<AtomicUsize>,
    ) -> Box<dyn DepthSource> {
        open.fetch_add(1, Ordering::SeqCst);
        Box::new(Self {
            steps: steps.into_iter().collect(),
            open: Arc::clone(open),
        })
    }
}

impl Drop for Script {
    fn drop(&mut self) {
        self.open.fetch_sub(1, Ordering::SeqCst);
    }
}

impl DepthSource for Script {
    fn title(&self) -> String {
        "Script".into()
    }

    fn is_simulated(&self) -> bool {
        false
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        self.steps.pop_front().unwrap_or_else(|| {
            thread::sleep(wait);
            Ok(NextCapture::NotYet)
        })
    }
}

fn numbers(range: std::ops::RangeInclusive<u64>) -> Vec<Result<NextCapture, CaptureError>> {
    range
        .map(|number| Ok(NextCapture::Captured(captured(number))))
        .collect()
}

/// A feed of what `script` returns for the first, second, ... opening.
fn feed_of(
    delivery: BackpressurePolicy,
    mut script: impl FnMut(usize) -> Result<Vec<Result<NextCapture, CaptureError>>, CaptureError>
    + Send
    + 'static,
) -> (Feed, Arc<AtomicUsize>) {
    let open = Arc::new(AtomicUsize::new(0));
    let theirs = Arc::clone(&open);
    let mut opening = 0;
    let source = move || {
        opening += 1;
        script(opening).map(|steps| Script::boxed(steps, &theirs))
    };
    (
        Feed::start_with(source, delivery, || ()).expect("a thread"),
        open,
    )
}

fn number_of(item: Option<FeedItem>) -> u64 {
    match item {
        Some(FeedItem::Captured(captured)) => captured.number,
        other => panic!("no capture: {other:?}"),
    }
}

fn wait_until(feed: &Feed, what: impl Fn(&FeedStatus) -> bool) -> FeedStatus {
    let until = Instant::now() + PATIENCE;
    loop {
        let status = feed.status();
        if what(&status) {
            return status;
        }
        assert!(Instant::now() < until, "still {status:?}");
        thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn where_every_capture_counts_all_come_in_order_and_then_the_end() {
    let (feed, open) = feed_of(BackpressurePolicy::Every, |_| {
        let mut steps = numbers(1..=20);
        steps.push(Ok(NextCapture::End));
        Ok(steps)
    });
    for number in 1..=20 {
        assert_eq!(number_of(feed.wait(PATIENCE)), number);
    }
    assert!(feed.wait(PATIENCE).is_none());
    let status = feed.status();
    assert!(matches!(status.state, FeedState::Ended), "{status:?}");
    assert_eq!(status.num_dropped, 0);
    drop(feed);
    assert_eq!(open.load(Ordering::SeqCst), 0);
}

#[test]
fn of_a_live_camera_only_the_newest_is_kept_and_the_others_are_counted() {
    let (feed, _) = feed_of(BackpressurePolicy::Newest, |_| {
        let mut steps = numbers(1..=20);
        steps.push(Ok(NextCapture::End));
        Ok(steps)
    });
    wait_until(&feed, |status| status.state.is_over());
    assert_eq!(number_of(feed.wait(Duration::ZERO)), 20);
    assert!(feed.wait(Duration::ZERO).is_none());
    assert_eq!(feed.status().num_dropped, 19);
}

#[test]
fn what_cannot_be_read_is_named_and_never_dropped_for_a_capture() {
    let (feed, _) = feed_of(BackpressurePolicy::Newest, |_| {
        let bad = |name: &str| {
            NextCapture::Skipped(SkippedCapture {
                name: name.into(),
                error: Arc::new(FileError::Empty { path: name.into() }.into()),
            })
        };
        let mut steps = numbers(1..=2);
        steps.push(Ok(bad("a.pcd")));
        steps.extend(numbers(3..=3));
        steps.push(Ok(bad("b.pcd")));
        steps.push(Ok(NextCapture::End));
        Ok(steps)
    });
    wait_until(&feed, |status| status.state.is_over());
    let names: Vec<String> = std::iter::from_fn(|| feed.wait(Duration::ZERO))
        .map(|item| match item {
            FeedItem::Captured(captured) => captured.name,
            FeedItem::Skipped(skipped) => skipped.name,
        })
        .collect();
    assert_eq!(names, ["a.pcd", "frame 3", "b.pcd"]);
}

#[test]
fn a_lost_source_is_asked_again_and_keeps_its_place() {
    let (feed, _) = feed_of(BackpressurePolicy::Every, |opening| {
        assert_eq!(opening, 1, "it must not be opened anew");
        let mut steps = numbers(1..=1);
        steps.push(Err(gone()));
        steps.extend(numbers(2..=2));
        Ok(steps)
    });
    assert_eq!(number_of(feed.wait(PATIENCE)), 1);
    let lost = wait_until(&feed, |status| {
        matches!(status.state, FeedState::Lost { .. })
    });
    assert!(lost.title.is_some());
    assert_eq!(number_of(feed.wait(PATIENCE)), 2);
    wait_until(&feed, |status| matches!(status.state, FeedState::Running));
}

#[test]
fn a_source_that_cannot_be_used_fails_with_its_reason() {
    let (feed, _) = feed_of(BackpressurePolicy::Every, |_| Err(hopeless()));
    assert!(feed.wait(PATIENCE).is_none());
    let status = feed.status();
    assert!(
        matches!(&status.state, FeedState::Failed(error) if error.to_string().contains("mesh"))
    );
    assert!(status.title.is_none());
}

#[test]
fn a_fault_of_the_source_is_a_state_and_not_silence() {
    let open = || -> Result<Box<dyn DepthSource>, CaptureError> { panic!("the driver's fault") };
    let feed = Feed::start_with(open, BackpressurePolicy::Every, || ()).expect("a thread");
    assert!(feed.wait(PATIENCE).is_none());
    let state = feed.status().state;
    assert!(matches!(&state, FeedState::Failed(error) if matches!(**error, CaptureError::Crashed)));
}

#[test]
fn it_stops_from_every_state_and_closes_its_source() {
    type Steps = fn(usize) -> Result<Vec<Result<NextCapture, CaptureError>>, CaptureError>;
    let running: Steps = |_| Ok(Vec::new());
    let blocked: Steps = |_| Ok(numbers(1..=3));
    let lost: Steps = |_| Ok(vec![Err(gone())]);
    let absent: Steps = |_| Err(gone());
    let ended: Steps = |_| Ok(vec![Ok(NextCapture::End)]);
    let failed: Steps = |_| Err(hopeless());
    for (steps, is_there) in [
        (
            running,
            (|state| matches!(state, FeedState::Running)) as fn(&FeedState) -> bool,
        ),
        (blocked, |state| matches!(state, FeedState::Running)),
        (lost, |state| matches!(state, FeedState::Lost { .. })),
        (absent, |state| matches!(state, FeedState::Lost { .. })),
        (ended, |state| matches!(state, FeedState::Ended)),
        (failed, |state| matches!(state, FeedState::Failed(_))),
    ] {
        let (feed, open) = feed_of(BackpressurePolicy::Every, steps);
        wait_until(&feed, |status| is_there(&status.state));
        feed.stop();
        let over = wait_until(&feed, |status| status.state.is_over());
        assert!(matches!(over.state, FeedState::Stopped) || is_there(&over.state));
        drop(feed);
        assert_eq!(open.load(Ordering::SeqCst), 0);
    }
}

#[test]
fn news_are_told_for_every_capture_and_the_end() {
    let num_notified = Arc::new(AtomicUsize::new(0));
    let theirs = Arc::clone(&num_notified);
    let open = Arc::new(AtomicUsize::new(0));
    let source = move || {
        let mut steps = numbers(1..=5);
        steps.push(Ok(NextCapture::End));
        Ok(Script::boxed(steps, &open))
    };
    let feed = Feed::start_with(source, BackpressurePolicy::Newest, move || {
        theirs.fetch_add(1, Ordering::SeqCst);
    })
    .expect("a thread");
    wait_until(&feed, |status| status.state.is_over());
    drop(feed);
    // Running, five captures, the end.
    assert_eq!(num_notified.load(Ordering::SeqCst), 7);
}

#[test]
fn a_tap_gets_the_newest_of_what_comes_and_takes_nothing_away() {
    let (feed, open) = feed_of(BackpressurePolicy::Every, |_| Ok(numbers(1..=5)));
    assert_eq!(number_of(feed.wait(PATIENCE)), 1);
    let tap = feed.tap();
    for number in 2..=5 {
        assert_eq!(number_of(feed.wait(PATIENCE)), number);
    }
    // It was put there before the feed itself received it.
    assert_eq!(number_of(tap.wait(PATIENCE)), 5);
    assert!(tap.wait(Duration::ZERO).is_none());
    let status = tap.status();
    assert!(matches!(status.state, FeedState::Running), "{status:?}");
    assert_eq!(status.title.as_deref(), Some("Script"));
    drop(tap);
    drop(feed.tap());
    let tap = feed.tap();
    drop(feed);
    assert_eq!(open.load(Ordering::SeqCst), 0, "a tap keeps nothing open");
    assert!(matches!(tap.status().state, FeedState::Stopped));
    assert!(tap.wait(PATIENCE).is_none());
}

#[test]
fn a_tap_knows_how_the_source_was_before_and_a_failed_feed_why() {
    let (feed, _) = feed_of(BackpressurePolicy::Newest, |_| Err(gone()));
    wait_until(&feed, |status| {
        matches!(status.state, FeedState::Lost { .. })
    });
    let tap = feed.tap();
    assert!(matches!(tap.status().state, FeedState::Lost { .. }));
    drop(feed);
    assert!(matches!(tap.status().state, FeedState::Stopped));
    let failed = Feed::failed(hopeless());
    assert!(failed.wait(PATIENCE).is_none());
    assert!(matches!(failed.status().state, FeedState::Failed(_)));
}

/// Threads of this process with the camera thread's name.
#[cfg(target_os = "linux")]
fn num_camera_threads(name: &str) -> usize {
    std::fs::read_dir("/proc/self/task")
        .expect("tasks")
        .filter_map(|task| std::fs::read_to_string(task.ok()?.path().join("comm")).ok())
        .filter(|comm| comm.trim() == name)
        .count()
}

#[cfg(target_os = "linux")]
#[test]
fn a_thousand_starts_and_stops_leave_no_thread_and_no_open_source() {
    let open = Arc::new(AtomicUsize::new(0));
    for round in 0..1000 {
        let theirs = Arc::clone(&open);
        let source = move || Ok(Script::boxed(numbers(1..=3), &theirs));
        let feed = Feed::start_with(source, BackpressurePolicy::Newest, || ()).expect("a thread");
        if round % 2 == 0 {
            feed.wait(PATIENCE);
        }
        drop(feed);
        assert_eq!(open.load(Ordering::SeqCst), 0, "round {round}");
    }
    // Other tests of this process have feeds at the same time, but few.
    assert!(num_camera_threads("camera") < 50);
}
