//! What is not baked twice: `--force`, and the cache that folders and scenes share.

use super::{Exit, Failure};
use crate::pipeline::{CACHE_LIMIT, Cache, Settings};
use bytesize::ByteSize;
use std::ffi::OsString;
use std::path::PathBuf;

/// The variable of the environment that names the cache.
const VARIABLE: &str = "BRDFBAKE_CACHE_DIR";

/// The cache of a verb.
#[derive(Debug, Clone, clap::Args)]
pub struct CacheArgs {
    /// Folder of the cache; else that of BRDFBAKE_CACHE_DIR (none if it is empty), else `brdfbake` where the system keeps caches.
    #[arg(long, value_name = "DIR")]
    cache_dir: Option<PathBuf>,
    /// Most bytes that the cache holds, such as 500MB; what was not used for longest goes first.
    #[arg(long, value_name = "SIZE", default_value_t = ByteSize::b(CACHE_LIMIT))]
    cache_size: ByteSize,
}

impl CacheArgs {
    /// The cache, if there is one.
    #[must_use]
    pub fn cache(&self) -> Option<Cache> {
        let given = || match std::env::var_os(VARIABLE) {
            Some(text) => Some(text).filter(|t| !t.is_empty()).map(PathBuf::from),
            None => default_folder(),
        };
        self.cache_dir.clone().or_else(given).map(|folder| Cache::new(folder, self.cache_size.as_u64()))
    }
}

/// What of earlier bakes a bake takes.
#[derive(Debug, Clone, clap::Args)]
pub struct Reuse {
    /// Bake everything, even what the output folder or the cache holds already.
    #[arg(long)]
    force: bool,
    /// Neither read nor write the cache.
    #[arg(long, conflicts_with_all = ["cache_dir", "cache_size"])]
    no_cache: bool,
    #[command(flatten)]
    cache: CacheArgs,
}

impl Reuse {
    /// Settings with it.
    #[must_use]
    pub fn settings(&self, settings: Settings) -> Settings {
        let cache = if self.no_cache { None } else { self.cache.cache() };
        Settings { force: self.force, cache, ..settings }
    }
}

/// `brdfbake` in the folder that the system has for caches.
fn default_folder() -> Option<PathBuf> {
    let variable = |name: &str| -> Option<PathBuf> {
        let text: OsString = std::env::var_os(name)?;
        Some(PathBuf::from(text)).filter(|p| p.is_absolute())
    };
    let home = || variable("HOME");
    let base = if cfg!(windows) {
        variable("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        home().map(|h| h.join("Library/Caches"))
    } else {
        variable("XDG_CACHE_HOME").or_else(|| home().map(|h| h.join(".cache")))
    };
    Some(base?.join("brdfbake"))
}

/// No cache where one is needed.
pub(super) fn none() -> Failure {
    Failure::new(
        Exit::Usage,
        format!("there is no cache: {VARIABLE} is empty, or the system names no folder; give --cache-dir"),
    )
}
