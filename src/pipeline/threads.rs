//! How many threads a run may use.

use super::PipelineError;

/// Most threads of a run, whoever asks for them.
pub const MOST_THREADS: usize = 1024;

/// The variable that sets the number of threads where nothing else does.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// A pool of threads: `jobs`, or what the environment variable `RAYON_NUM_THREADS` says, or one a core.
///
/// # Errors
/// [`PipelineError::Jobs`] for more than [`MOST_THREADS`], [`PipelineError::Threads`] if the system does not give as many.
pub fn pool(jobs: Option<usize>) -> Result<rayon::ThreadPool, PipelineError> {
    let set = std::env::var(VARIABLE).ok();
    let cores = || std::thread::available_parallelism().map_or(1, |n| n.get().min(MOST_THREADS));
    let (jobs, from) = match (jobs, set.as_deref().and_then(number)) {
        (Some(n), _) if n > 0 => (n, "jobs"),
        (_, Some(n)) => (n, VARIABLE),
        _ => (cores(), "jobs"),
    };
    if jobs > MOST_THREADS {
        return Err(PipelineError::Jobs { from, jobs, limit: MOST_THREADS });
    }
    let threads = rayon::ThreadPoolBuilder::new().num_threads(jobs);
    threads.build().map_err(|e| PipelineError::Threads { jobs, message: e.to_string() })
}

/// A number as the thread library reads it, numbers too large for a `usize` included; `None` for 0 and for anything else.
fn number(text: &str) -> Option<usize> {
    let text = text.strip_prefix('+').unwrap_or(text);
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    digits.then(|| text.parse().unwrap_or(usize::MAX)).filter(|n| *n > 0)
}
