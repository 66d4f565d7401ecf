//! Distributes pieces of work over threads and returns the results in order.
//!
//! Stages start threads only here. A stage remains a pure function: it states how many pieces there are and how many
//! workers may share them, and gets bit-identical results for any number of workers, because the pieces are independent
//! and nothing is summed here. Threads are started per call and end with it: a pool would save about ten microseconds
//! per thread, but would be global state that outlives its callers. Work that already shares the cores with other workers
//! starts no further threads.

use std::{
    cell::Cell,
    num::NonZero,
    panic::resume_unwind,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

thread_local! {
    /// True while this thread may not share its work.
    static IS_ONE_CORE: Cell<bool> = const { Cell::new(false) };
}

/// Returns the number of processor cores available to the caller: one for a worker, and within [`on_one_core`].
pub fn num_cores() -> usize {
    if IS_ONE_CORE.get() {
        return 1;
    }
    thread::available_parallelism().map_or(1, NonZero::get)
}

/// Runs `work` on this thread alone.
pub fn on_one_core<T>(work: impl FnOnce() -> T) -> T {
    struct Restore(bool);
    impl Drop for Restore {
        fn drop(&mut self) {
            IS_ONE_CORE.set(self.0);
        }
    }
    let _restore = Restore(IS_ONE_CORE.replace(true));
    work()
}

/// Runs `work` on each of `0..num_pieces` with up to `num_workers` workers; returns the results in order.
///
/// Each worker creates its state, such as buffers, with `prepare` and passes it to all of its pieces; the results must
/// not depend on what earlier pieces left in it. With one worker or one piece no thread is started.
pub fn map_in_order<S, T: Send>(
    num_pieces: usize,
    num_workers: usize,
    prepare: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, usize) -> T + Sync,
) -> Vec<T> {
    let num_workers = num_workers.min(num_pieces);
    if num_workers <= 1 {
        let mut state = prepare();
        return (0..num_pieces).map(|i| work(&mut state, i)).collect();
    }
    // Small enough that no worker waits long for the last block, large enough that taking a block costs nothing.
    let block = (num_pieces / (num_workers * BLOCKS_PER_WORKER)).max(1);
    let next = AtomicUsize::new(0);
    let take_blocks = || {
        let mut state = prepare();
        let mut done: Vec<(usize, Vec<T>)> = Vec::new();
        loop {
            let start = next.fetch_add(block, Ordering::Relaxed);
            if start >= num_pieces {
                return done;
            }
            let end = num_pieces.min(start + block);
            done.push((start, (start..end).map(|i| work(&mut state, i)).collect()));
        }
    };
    let mut blocks = thread::scope(|scope| {
        let worker = || on_one_core(take_blocks);
        let others: Vec<_> = (1..num_workers).map(|_| scope.spawn(worker)).collect();
        let mut blocks = worker();
        for other in others {
            match other.join() {
                Ok(done) => blocks.extend(done),
                Err(panic) => resume_unwind(panic),
            }
        }
        blocks
    });
    blocks.sort_by_key(|(start, _)| *start);
    blocks
        .into_iter()
        .flat_map(|(_, results)| results)
        .collect()
}

/// As [`map_in_order`], for work that needs no state.
pub fn map_each<T: Send>(
    num_pieces: usize,
    num_workers: usize,
    work: impl Fn(usize) -> T + Sync,
) -> Vec<T> {
    map_in_order(num_pieces, num_workers, || (), |(), i| work(i))
}

/// Runs `here` on this thread and `work` on each of `0..num_pieces`, each on a thread of its own beside it; returns the results
/// in order. None of them starts further threads; without pieces, `here` may.
pub fn map_beside<H, T: Send>(
    num_pieces: usize,
    work: impl Fn(usize) -> T + Sync,
    here: impl FnOnce() -> H,
) -> (H, Vec<T>) {
    if num_pieces == 0 {
        return (here(), Vec::new());
    }
    let work = &work;
    thread::scope(|scope| {
        let beside = |i| scope.spawn(move || on_one_core(|| work(i)));
        let others: Vec<_> = (0..num_pieces).map(beside).collect();
        let found = on_one_core(here);
        let joined = others.into_iter().map(|other| match other.join() {
            Ok(found) => found,
            Err(panic) => resume_unwind(panic),
        });
        (found, joined.collect())
    })
}

/// Number of blocks per worker, on average.
const BLOCKS_PER_WORKER: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_results_are_in_order_for_any_number_of_workers() {
        for num_pieces in [0, 1, 2, 7, 64, 1001] {
            let serial: Vec<usize> = (0..num_pieces).map(|i| i * i).collect();
            for num_workers in [0, 1, 2, 3, 8, 50] {
                let found = map_in_order(num_pieces, num_workers, || (), |(), i| i * i);
                assert_eq!(found, serial, "{num_pieces} by {num_workers}");
            }
        }
    }

    #[test]
    fn a_worker_keeps_its_state_from_piece_to_piece() {
        let prepared = AtomicUsize::new(0);
        let prepare = || prepared.fetch_add(1, Ordering::Relaxed);
        map_in_order(100, 4, prepare, |_, i| i);
        assert!(prepared.load(Ordering::Relaxed) <= 4);
    }

    #[test]
    fn workers_start_no_further_threads() {
        let found = map_in_order(8, 3, || (), |(), _| num_cores());
        assert_eq!(found, [1; 8]);
        assert_eq!(on_one_core(num_cores), 1);
        let before = num_cores();
        let caught = std::panic::catch_unwind(|| on_one_core(|| panic!("ends the work")));
        assert!(caught.is_err());
        assert_eq!(num_cores(), before, "allowed again");
    }

    #[test]
    fn pieces_beside_are_in_order_and_start_no_further_threads() {
        let found = map_beside(3, |i| (i, num_cores()), num_cores);
        assert_eq!(found, (1, vec![(0, 1), (1, 1), (2, 1)]));
        let alone = map_beside(0, |i| i, num_cores);
        assert_eq!(alone, (num_cores(), Vec::new()));
    }

    #[test]
    #[should_panic(expected = "piece 30")]
    fn a_panic_in_a_piece_comes_out() {
        map_in_order(40, 4, || (), |(), i| assert!(i != 30, "piece {i}"));
    }
}
