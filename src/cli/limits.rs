//! What a run may use: threads, time, memory. The same options for every verb that bakes.

use crate::pipeline::Settings;
use bytesize::ByteSize;
use std::path::Path;
use std::time::Duration;

/// Options of every verb that bakes.
#[derive(Debug, Clone, clap::Args)]
pub struct Limits {
    /// Number of threads; all cores if not given. The bytes do not depend on it.
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// How long to wait for another run that writes into the output folder.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    lock_timeout: Duration,
    /// Most memory that the bake may take, such as 512MB or 8GiB; 4GiB if not given, or what the machine has available if that
    /// is less. What does not fit is refused before it is baked.
    #[arg(long, value_name = "SIZE")]
    memory: Option<ByteSize>,
    /// Bake a plan of 1e8 texels or 4 GiB and more, which is refused otherwise with what it costs.
    #[arg(long)]
    yes_large: bool,
}

impl Limits {
    /// Number of threads, if it is given.
    #[must_use]
    pub fn jobs(&self) -> Option<usize> {
        self.jobs.map(usize::from)
    }

    /// Settings of a run into a folder.
    #[must_use]
    pub fn settings(&self, out: &Path) -> Settings {
        let memory = self.memory.map(|m| m.as_u64());
        Settings {
            jobs: self.jobs(),
            lock_timeout: self.lock_timeout,
            memory,
            large: self.yes_large,
            ..Settings::new(out)
        }
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let number: f64 = text.parse().map_err(|_| "it is no number of seconds".to_owned())?;
    Duration::try_from_secs_f64(number).map_err(|e| e.to_string())
}
