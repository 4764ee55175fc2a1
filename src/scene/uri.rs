//! Where a scene's URI may point: into the scene's own folder, or into itself (`data:`). Nowhere else.
//!
//! The rules are the same on every system, so that a file is refused everywhere or nowhere:
//!
//! 1. `data:` is allowed up to a size; any other scheme (`http:`, `file:`, and so a drive letter) is refused.
//! 2. Percent escapes are decoded once, `%2F` too, and what comes out is judged. What then still holds an escape was encoded twice
//!    and is refused.
//! 3. No absolute path, no backslash, no colon, no control character. `..` takes the name before it away; a path that leads out of
//!    the folder is no fault, for exporters write such, but is opened only below a root that the user names.
//! 4. No name that Windows reads in its own way: `con`, `nul.png`, a dot or a blank at the end.
//! 5. [`resolve_uri`] also follows symbolic links and refuses one that leads out of the root.
//!
//! [`read`](super::read) applies rules 1 to 4 to every buffer and image and opens none of them.

use std::io;
use std::path::{Path, PathBuf};

/// Longest URI that is not `data:`, in bytes.
pub const LONGEST_URI: usize = 4096;

/// Why a URI was refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UriError {
    /// Nothing to point at.
    #[error("empty")]
    Empty,
    /// Longer than [`LONGEST_URI`].
    #[error("{bytes} bytes long, allowed {LONGEST_URI}")]
    TooLong {
        /// Length of the URI.
        bytes: usize,
    },
    /// A scheme other than `data:`. A drive letter looks the same.
    #[error("scheme `{scheme}:`, allowed `data:` and paths in the scene's folder")]
    Scheme {
        /// The scheme, lower case.
        scheme: String,
    },
    /// A path from the root of the file system or of a server.
    #[error("absolute path, allowed paths in the scene's folder")]
    Absolute,
    /// A path that leads out of the root.
    #[error("`..` leaves the scene's folder; name a folder that holds both with `--root`")]
    Parent,
    /// A backslash: a separator on one system, a letter on another.
    #[error("backslash, allowed `/` as the separator")]
    Backslash,
    /// A colon: a drive or a hidden stream on Windows.
    #[error("colon in a name")]
    Colon,
    /// NUL, newline and their kind, plain or escaped.
    #[error("control character U+{code:04X}")]
    Control {
        /// The code point.
        code: u32,
    },
    /// `%252e`: still escaped after decoding.
    #[error("escaped twice")]
    EscapedTwice,
    /// Escapes that do not decode to UTF-8.
    #[error("escapes are not UTF-8")]
    NotUtf8,
    /// A name that Windows reads in its own way.
    #[error("name `{name}` is read as another one on Windows")]
    Reserved {
        /// The name.
        name: String,
    },
    /// A `data:` URI without the comma before its data.
    #[error("`data:` without a comma")]
    DataWithoutComma,
    /// A `data:` URI that is too large.
    #[error("`data:` of {bytes} bytes, allowed {limit}")]
    DataTooLarge {
        /// Size after decoding.
        bytes: u64,
        /// The limit.
        limit: u64,
    },
    /// A symbolic link that leads out of the scene's folder, or to nothing.
    #[error("symbolic link `{link}` leads out of the scene's folder")]
    LinkOutside {
        /// The link, relative to the scene's folder.
        link: String,
    },
    /// The file system refused to say what is there.
    #[error("cannot look at the path: {source}")]
    Io {
        /// The system's reason.
        #[source]
        source: io::Error,
    },
}

/// A URI that passed rules 1 to 4.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Checked {
    /// The data itself, of this many bytes after decoding. It was not decoded.
    Data {
        /// Size after decoding; for base64 an upper bound that is at most 2 bytes off.
        bytes: u64,
    },
    /// A path in the scene's folder: its names, decoded. `.`, `..` and empty names are gone.
    Inside(Vec<String>),
    /// A path out of it: `..` as often as it leads up, then names.
    Above(Vec<String>),
}

/// A URI that also passed rule 5.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Resolved {
    /// The data itself.
    Data {
        /// Size after decoding, as in [`Checked::Data`].
        bytes: u64,
    },
    /// A path below the canonical scene folder. It may not exist.
    File(PathBuf),
}

/// Rules 1 to 4: what can be said without looking at a disk. `max_data` bounds a `data:` URI, in bytes.
///
/// # Errors
/// The first rule that the URI breaks.
///
/// ```
/// use brdfbake::scene::{Checked, check_uri};
/// assert_eq!(check_uri("tex/my%20wood.png", 0)?, Checked::Inside(vec!["tex".into(), "my wood.png".into()]));
/// assert_eq!(check_uri("tex/%2e%2e/%2e%2e/a.png", 0)?, Checked::Above(vec!["..".into(), "a.png".into()]));
/// assert!(check_uri("/etc/passwd", 0).is_err());
/// # Ok::<(), brdfbake::scene::UriError>(())
/// ```
pub fn check_uri(uri: &str, max_data: u64) -> Result<Checked, UriError> {
    match scheme(uri) {
        Some(scheme) if scheme == "data" => return check_data(uri, max_data),
        // A long scheme is an attack on the message, not a scheme.
        Some(scheme) => return Err(UriError::Scheme { scheme: scheme.chars().take(32).collect() }),
        None => {}
    }
    if uri.len() > LONGEST_URI {
        return Err(UriError::TooLong { bytes: uri.len() });
    }
    let path = decode(uri)?;
    if escapes(path.as_bytes()) {
        return Err(UriError::EscapedTwice);
    }
    check_path(&path)
}

/// Rules 3 and 4, on the decoded path.
fn check_path(path: &str) -> Result<Checked, UriError> {
    if path.contains('\\') {
        return Err(UriError::Backslash);
    }
    if path.starts_with('/') {
        return Err(UriError::Absolute);
    }
    if let Some(control) = path.chars().find(|c| c.is_control()) {
        return Err(UriError::Control { code: control.into() });
    }
    if path.contains(':') {
        return Err(UriError::Colon);
    }
    let mut names = Vec::new();
    for name in path.split('/').filter(|name| !name.is_empty() && *name != ".") {
        if name == ".." {
            match names.last() {
                Some(last) if last != ".." => drop(names.pop()),
                _ => names.push(name.to_owned()),
            }
            continue;
        }
        if reserved(name) {
            return Err(UriError::Reserved { name: name.chars().take(64).collect() });
        }
        names.push(name.to_owned());
    }
    match names.first().map(String::as_str) {
        None => Err(UriError::Empty),
        Some("..") => Ok(Checked::Above(names)),
        Some(_) => Ok(Checked::Inside(names)),
    }
}

/// The file that a URI of a scene in `base_dir` means, by all five rules, the folder being the root.
///
/// # Errors
/// The first rule that the URI breaks, [`UriError::Parent`] for a path out of the folder, or [`UriError::Io`] if the folder cannot be
/// looked at.
pub fn resolve_uri(base_dir: &Path, uri: &str, max_data: u64) -> Result<Resolved, UriError> {
    match check_uri(uri, max_data)? {
        Checked::Data { bytes } => Ok(Resolved::Data { bytes }),
        Checked::Inside(names) | Checked::Above(names) => {
            resolve(base_dir, base_dir, &names).map(Resolved::File)
        }
    }
}

/// The file of a path that passed rules 1 to 4, from a scene in `base_dir`, below `root`.
///
/// Nothing is opened. A path that does not exist is fine: opening it will say so. Open the returned path at
/// once: whoever may write into the folder can still swap a name for a link in between.
///
/// # Errors
/// [`UriError::Parent`] for a path out of the root, [`UriError::LinkOutside`] for such a link, [`UriError::Io`] if a folder cannot be
/// looked at.
pub fn resolve(base_dir: &Path, root: &Path, names: &[String]) -> Result<PathBuf, UriError> {
    let io = |source| UriError::Io { source };
    let root = root.canonicalize().map_err(io)?;
    let mut path = base_dir.canonicalize().map_err(io)?;
    if !path.starts_with(&root) {
        return Err(UriError::Parent);
    }
    let mut exists = true;
    for name in names {
        if name == ".." {
            // only in front, where the folder has no link in it any more
            if path == root || !path.pop() {
                return Err(UriError::Parent);
            }
            continue;
        }
        path.push(name);
        if !exists {
            continue;
        }
        match path.symlink_metadata() {
            Ok(found) if found.is_symlink() => path = follow(&root, &path)?,
            Ok(_) => {}
            // `a.png/b` and `missing/b` exist for nobody; the rest of the path is only names.
            Err(e) if matches!(e.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                exists = false
            }
            Err(source) => return Err(UriError::Io { source }),
        }
    }
    Ok(path)
}

/// Where a link ends, if that is inside the root. A link to nothing is refused: the target may appear later.
fn follow(root: &Path, link: &Path) -> Result<PathBuf, UriError> {
    match link.canonicalize() {
        Ok(target) if target.starts_with(root) => Ok(target),
        _ => {
            let shown = link.strip_prefix(root).unwrap_or(link);
            Err(UriError::LinkOutside { link: shown.to_string_lossy().into_owned() })
        }
    }
}

/// The scheme of RFC 3986 §3.1, lower case: letters, digits, `+`, `-`, `.` up to a colon. `C:` is one too.
fn scheme(uri: &str) -> Option<String> {
    let (scheme, _) = uri.split_once(':')?;
    let letter = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'+' | b'-' | b'.');
    let starts = scheme.as_bytes().first().is_some_and(u8::is_ascii_alphabetic);
    (starts && scheme.bytes().all(letter)).then(|| scheme.to_ascii_lowercase())
}

fn check_data(uri: &str, limit: u64) -> Result<Checked, UriError> {
    let (head, data) = uri.split_once(',').ok_or(UriError::DataWithoutComma)?;
    let len = u64::try_from(data.len()).unwrap_or(u64::MAX);
    let base64 = head.len() >= 7 && head.as_bytes()[head.len() - 7..].eq_ignore_ascii_case(b";base64");
    let bytes = if base64 { len / 4 * 3 + len % 4 } else { len };
    if bytes > limit { Err(UriError::DataTooLarge { bytes, limit }) } else { Ok(Checked::Data { bytes }) }
}

/// The byte that an escape at the start of `text` stands for.
fn escape(text: &[u8]) -> Option<u8> {
    let digit =
        |i: usize| text.get(i).and_then(|b| char::from(*b).to_digit(16)).and_then(|d| u8::try_from(d).ok());
    if text.first() == Some(&b'%') { Some(digit(1)? * 16 + digit(2)?) } else { None }
}

fn escapes(text: &[u8]) -> bool {
    (0..text.len()).any(|i| escape(&text[i..]).is_some())
}

/// Percent escapes decoded once. A `%` that starts no escape stays: exporters forget to escape it.
fn decode(uri: &str) -> Result<String, UriError> {
    let mut rest = uri.as_bytes();
    let mut out = Vec::with_capacity(rest.len());
    while let Some((first, tail)) = rest.split_first() {
        match escape(rest) {
            Some(byte) => {
                out.push(byte);
                rest = &rest[3..];
            }
            None => {
                out.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(out).map_err(|_| UriError::NotUtf8)
}

/// Names that Windows gives to a device, or reads without their last character.
fn reserved(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or(name).trim_end();
    let device =
        ["con", "prn", "aux", "nul", "conin$", "conout$"].iter().any(|d| stem.eq_ignore_ascii_case(d));
    let port = |kind: &str| {
        let (head, number) = stem.split_at_checked(3).unwrap_or((stem, ""));
        head.eq_ignore_ascii_case(kind)
            && matches!(number, "0" | "1" | "2" | "3" | "4" | "5" | "6" | "7" | "8" | "9" | "¹" | "²" | "³")
    };
    name.ends_with(['.', ' ']) || device || port("com") || port("lpt")
}
