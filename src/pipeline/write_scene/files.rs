//! Where a scene is written, and the files that it takes along.

use super::{Request, SceneWriteError};
use crate::math::shown::show;
use crate::scene::decode_data;
use crate::scene::write::{Draft, Reference, escape, references};
use crate::scene::{Checked, check_uri, resolve};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// Where a scene is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Target {
    /// The folder.
    pub folder: PathBuf,
    /// Name of the scene in it.
    pub name: String,
    /// Is it a GLB?
    pub binary: bool,
}

/// What could not be taken along.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Note {
    /// A file that the scene names is not there.
    Missing {
        /// JSON path.
        at: String,
        /// The URI.
        uri: String,
    },
    /// A URI of an extension that is not followed.
    NotFollowed {
        /// JSON path.
        at: String,
        /// The URI.
        uri: String,
        /// Why not.
        why: String,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Note::Missing { at, uri } => {
                write!(f, "{at}: there is no file {}, and none was copied", show(uri))
            }
            Note::NotFollowed { at, uri, why } => write!(f, "{at}: {} was not copied: {why}", show(uri)),
        }
    }
}

/// `.gltf` or `.glb`, in any case: is it the latter?
fn container(path: &Path) -> Option<bool> {
    let end = path.extension()?.to_str()?;
    if end.eq_ignore_ascii_case("glb") {
        Some(true)
    } else {
        end.eq_ignore_ascii_case("gltf").then_some(false)
    }
}

impl Target {
    /// The place that a request names.
    ///
    /// # Errors
    /// [`SceneWriteError::Place`] and [`SceneWriteError::Itself`].
    pub fn of(request: &Request) -> Result<Target, SceneWriteError> {
        let (to, scene) = (&request.to, &request.scene);
        let file = if container(to).is_some() && !to.is_dir() {
            to.clone()
        } else {
            to.join(scene.file_name().unwrap_or_default())
        };
        let wrong = || SceneWriteError::Place { path: to.clone() };
        let name = file.file_name().and_then(|n| n.to_str()).ok_or_else(wrong)?.to_owned();
        let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        if same_file::is_same_file(&file, scene).unwrap_or(false) {
            return Err(SceneWriteError::Itself { path: file });
        }
        // a scene without the usual ending keeps its container
        let binary = container(&file).unwrap_or_else(|| {
            let start = fs::File::open(scene).and_then(|mut f| {
                let mut start = [0; 4];
                std::io::Read::read_exact(&mut f, &mut start).map(|()| start)
            });
            start.is_ok_and(|s| s == *b"glTF")
        });
        Ok(Target { folder, name, binary })
    }

    /// Its name without the ending.
    #[must_use]
    pub fn stem(&self) -> &str {
        self.name.rsplit_once('.').map_or(self.name.as_str(), |(stem, _)| stem)
    }

    /// What stands before the name of a file of a folder in a path relative to the scene, if the folder lies in the scene's.
    pub(super) fn path_of(&self, folder: &Path) -> Option<String> {
        let (own, other) = (self.folder.canonicalize().ok()?, folder.canonicalize().ok()?);
        let rest = other.strip_prefix(own).ok()?;
        let mut out = String::new();
        for part in rest.components() {
            out.push_str(part.as_os_str().to_str()?);
            out.push('/');
        }
        Some(out)
    }
}

/// A draft, the files that it takes along, and which files are read.
pub(super) struct Copies {
    pub(super) draft: Draft,
    pub(super) inputs: Vec<PathBuf>,
    pub(super) files: Vec<(String, Vec<u8>)>,
    pub(super) notes: Vec<Note>,
}

/// The folder of a scene.
pub(super) fn base(scene: &Path) -> &Path {
    scene.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The bytes of a URI; none if it is a file that is not there.
pub(super) fn fetch(request: &Request, at: &str, uri: &str) -> Result<Option<Vec<u8>>, SceneWriteError> {
    let failed = |source| SceneWriteError::Uri { at: at.to_owned(), source };
    match check_uri(uri, request.limits.data_uri_bytes).map_err(failed)? {
        Checked::Data { .. } => {
            let data = decode_data(uri);
            data.map(Some).map_err(|source| SceneWriteError::Data { at: at.to_owned(), source })
        }
        Checked::Inside(names) | Checked::Above(names) => read(request, at, &names),
    }
}

/// The bytes of the file with these path names; none if it is not there.
pub(super) fn read(
    request: &Request,
    at: &str,
    names: &[String],
) -> Result<Option<Vec<u8>>, SceneWriteError> {
    let failed = |source| SceneWriteError::Uri { at: at.to_owned(), source };
    let folder = base(&request.scene);
    let path = resolve(folder, request.root.as_deref().unwrap_or(folder), names).map_err(failed)?;
    if !path.is_file() {
        return Ok(None);
    }
    fs::read(&path).map(Some).map_err(|source| SceneWriteError::Read { path, source })
}

/// The bytes of the first buffer of a `.gltf` file, if it has a URI.
pub(super) fn first_buffer(draft: &Draft, request: &Request) -> Result<Option<Vec<u8>>, SceneWriteError> {
    let all = references(&draft.parts.text).unwrap_or_default();
    let Some(first) = all.iter().find(|r| r.at() == FIRST) else { return Ok(None) };
    let path = || base(&request.scene).join(&first.uri);
    fetch(request, FIRST, &first.uri)?
        .map(Some)
        .ok_or_else(|| SceneWriteError::Read { path: path(), source: std::io::ErrorKind::NotFound.into() })
}

/// JSON path of the URI of the first buffer.
const FIRST: &str = "buffers[0].uri";

/// The files that a scene names, to be copied to where it will look for them.
pub(super) fn copies(draft: Draft, request: &Request, target: &Target) -> Result<Copies, SceneWriteError> {
    let mut out = Copies { draft, inputs: vec![request.scene.clone()], files: Vec::new(), notes: Vec::new() };
    let all = references(&out.draft.parts.text).unwrap_or_default();
    let packed = out.draft.embeds();
    let wanted = || all.iter().filter(|r| !(packed && r.at() == FIRST));
    // files below the scene keep their names; those from above take what is left
    for above in [false, true] {
        for reference in wanted() {
            if matches!(check_uri(&reference.uri, u64::MAX), Ok(Checked::Above(_))) == above {
                copy(reference, request, target, &mut out)?;
            }
        }
    }
    Ok(out)
}

/// A name for bytes in place of one that may be taken by others: in the folder, or among the files that the scene takes along.
fn free_name(name: &str, bytes: &[u8], target: &Target, out: &Copies) -> String {
    let taken = |name: &str| {
        let own = out.files.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, b)| b == bytes);
        let path = target.folder.join(name);
        let there = || path.exists().then(|| fs::read(&path).is_ok_and(|old| old == bytes));
        own.or_else(there).is_some_and(|same| !same) || name.eq_ignore_ascii_case(&target.name)
    };
    if !taken(name) {
        return name.to_owned();
    }
    // the same bytes always get the same name
    let hash = blake3::hash(bytes).to_hex();
    let (stem, end) = match name.rsplit_once('.').filter(|(_, end)| !end.contains('/')) {
        Some((stem, end)) => (stem, format!(".{end}")),
        None => (name, String::new()),
    };
    [8, 16, 32]
        .map(|n| format!("{stem}-{}{end}", &hash[..n]))
        .into_iter()
        .find(|n| !taken(n))
        .unwrap_or_else(|| format!("{stem}-{hash}{end}"))
}

fn copy(
    reference: &Reference,
    request: &Request,
    target: &Target,
    out: &mut Copies,
) -> Result<(), SceneWriteError> {
    let (at, uri) = (reference.at(), &reference.uri);
    let names = match check_uri(uri, u64::MAX) {
        Ok(Checked::Data { .. }) => return Ok(()),
        Ok(Checked::Inside(names)) => names,
        Ok(Checked::Above(names)) => return copy_from_above(reference, &names, request, target, out),
        Err(why) => {
            // those of buffers and images were judged when the scene was read
            out.notes.push(Note::NotFollowed { at, uri: uri.clone(), why: why.to_string() });
            return Ok(());
        }
    };
    let name = names.join("/");
    let source = base(&request.scene).join(&name);
    if source.is_file() {
        out.inputs.push(source.clone());
    }
    if same_file::is_same_file(&source, target.folder.join(&name)).unwrap_or(false)
        || out.files.iter().any(|(n, _)| *n == name)
    {
        return Ok(());
    }
    match fetch(request, &at, uri)? {
        Some(bytes) => out.files.push((name, bytes)),
        None => out.notes.push(Note::Missing { at, uri: uri.clone() }),
    }
    Ok(())
}

/// A file above the scene's folder: where the scene is written beside the old one it stays, else it is copied to its path below the
/// root, and its URI says so. A file of other bytes that has this name, there or among those of the scene, keeps it: the copy then gets a
/// name with a part of its hash.
fn copy_from_above(
    reference: &Reference,
    names: &[String],
    request: &Request,
    target: &Target,
    out: &mut Copies,
) -> Result<(), SceneWriteError> {
    let (at, uri, folder) = (reference.at(), reference.uri.clone(), base(&request.scene));
    if target.folder.canonicalize().ok() == folder.canonicalize().ok() {
        return Ok(());
    }
    let found = match request.root.as_deref().map(|root| (root, resolve(folder, root, names))) {
        Some((root, Ok(path))) => root.canonicalize().ok().and_then(|root| {
            let below = path.strip_prefix(root).ok()?.components().map(|c| c.as_os_str().to_str());
            Some(below.collect::<Option<Vec<_>>>()?.join("/"))
        }),
        Some((_, Err(source))) => return Err(SceneWriteError::Uri { at, source }),
        None => None,
    };
    let Some(name) = found else {
        let why = "it lies outside the scene's folder, and no root allows that (--root)".to_owned();
        out.notes.push(Note::NotFollowed { at, uri, why });
        return Ok(());
    };
    let Some(bytes) = fetch(request, &at, &uri)? else {
        out.notes.push(Note::Missing { at, uri });
        return Ok(());
    };
    let name = free_name(&name, &bytes, target, out);
    if !out.files.iter().any(|(other, _)| *other == name) {
        out.files.push((name.clone(), bytes));
    }
    reference.patch(&mut out.draft.patch).set(serde_json::Value::from(escape(&name)));
    Ok(())
}

/// No two files in one place, and none in that of a file that is read.
pub(super) fn check(
    new: &[(String, Vec<u8>)],
    copied: &[(String, Vec<u8>)],
    inputs: &[PathBuf],
    target: &Target,
) -> Result<(), SceneWriteError> {
    for (i, (name, bytes)) in new.iter().enumerate() {
        let path = target.folder.join(name);
        let twice = |(other, _): &(String, Vec<u8>)| other.eq_ignore_ascii_case(name);
        if new[..i].iter().any(twice) || copied.iter().any(twice) {
            return Err(SceneWriteError::Twice { path });
        }
        let read = inputs.iter().any(|input| same_file::is_same_file(input, &path).unwrap_or(false));
        if read && fs::read(&path).map_or(true, |old| old != *bytes) {
            return Err(SceneWriteError::Overwrites { path });
        }
    }
    Ok(())
}
