//! Memory, threads and handles of this process; a leak with every frame would exhaust them in the end.

use std::fs;

use serde::Serialize;

/// Resources that this process holds.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ProcessUsage {
    /// Resident memory, megabytes.
    pub memory_mb: f64,
    /// Number of threads.
    pub num_threads: usize,
    /// Number of open files, sockets and devices.
    pub num_handles: usize,
}

impl ProcessUsage {
    /// Reads the present usage; `None` where the system does not report it.
    pub fn now() -> Option<Self> {
        let status = fs::read_to_string("/proc/self/status").ok()?;
        let number = |name: &str| -> Option<f64> {
            let mut lines = status.lines();
            let rest = lines.find_map(|line| line.strip_prefix(name))?;
            rest.split_whitespace().next()?.parse().ok()
        };
        Some(Self {
            memory_mb: number("VmRSS:")? / 1024.0,
            num_threads: number("Threads:")? as usize,
            // Excludes the handle that lists the folder.
            num_handles: fs::read_dir("/proc/self/fd").ok()?.count().checked_sub(1)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn what_is_held_is_counted() {
        let before = ProcessUsage::now().expect("Linux tells");
        let file = fs::File::open("Cargo.toml").expect("there");
        let memory = std::hint::black_box(vec![1_u8; 64 << 20]);
        let now = ProcessUsage::now().expect("Linux tells");
        // Allows for other tests that run at the same time.
        assert!(
            now.memory_mb > before.memory_mb + 20.0,
            "{before:?} {now:?}"
        );
        assert!(now.num_threads > 0 && now.num_handles > 3, "{now:?}");
        drop((file, memory));
    }
}
