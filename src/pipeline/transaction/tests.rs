//! Killed after every step, with an error at every file, and two at once.

use super::journal::{Journal, Paths, Step, recover};
use super::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

static GO: Cancel = Cancel::new();

/// Files of a bake: name and bytes.
type Files = BTreeMap<String, Vec<u8>>;

fn files(list: &[(&str, &str)]) -> Files {
    list.iter().map(|(n, b)| ((*n).to_owned(), b.as_bytes().to_vec())).collect()
}

/// The bake before: `gone` is of no other.
fn old() -> Files {
    files(&[("a", "old a"), ("b", "old b"), ("gone", "gone"), ("same", "same")])
}

/// The bake that is killed: a longer file, one of the same length, a new one, one with the same bytes.
fn new() -> Files {
    files(&[("a", "the new a"), ("b", "new b"), ("c", "new c"), ("same", "same")])
}

fn manifest(files: &Files) -> Vec<u8> {
    let hashes: BTreeMap<&String, String> =
        files.iter().map(|(n, b)| (n, blake3::hash(b).to_hex().to_string())).collect();
    serde_json::to_vec(&hashes).unwrap()
}

fn begin(folder: &Path) -> (Transaction<'static>, Option<Recovery>) {
    let waiting = Waiting { timeout: Duration::from_secs(60), told: &|| {} };
    Transaction::begin(folder, &[], &GO, &waiting).unwrap()
}

fn staged(folder: &Path, files: &Files) -> Transaction<'static> {
    let (mut transaction, _) = begin(folder);
    files.iter().for_each(|(name, bytes)| transaction.stage(name, bytes).unwrap());
    transaction
}

fn write(folder: &Path, files: &Files) -> Result<Written, TransactionError> {
    staged(folder, files).commit(&manifest(files))
}

/// What a folder holds; nothing hidden may be in it.
fn held(folder: &Path) -> Files {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap());
    entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
}

/// Both bakes, the first one's own file included, and the manifest of the second.
fn both() -> Files {
    let mut all = old();
    all.extend(new());
    all.insert(MANIFEST.to_owned(), manifest(&new()));
    all
}

fn before() -> Files {
    let mut all = old();
    all.insert(MANIFEST.to_owned(), manifest(&old()));
    all
}

/// A manifest, if there is one, tells the truth.
fn assert_honest(folder: &Path, when: &str) {
    let Ok(text) = fs::read(folder.join(MANIFEST)) else { return };
    let hashes: BTreeMap<String, String> = serde_json::from_slice(&text).unwrap();
    for (name, hash) in hashes {
        let bytes = fs::read(folder.join(&name)).unwrap_or_default();
        assert_eq!(blake3::hash(&bytes).to_hex().to_string(), hash, "{when}: {name} under a manifest");
    }
}

/// A folder with the old bake and a journal to the new one, as a killed run leaves it before its first rename.
fn prepared() -> (tempfile::TempDir, Paths, Journal) {
    let folder = tempfile::tempdir().unwrap();
    before().iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).unwrap());
    let paths = Paths::new(folder.path());
    for part in [paths.staging(), &paths.new_folder(), &paths.old_folder()] {
        fs::create_dir(part).unwrap();
    }
    let mut all = new();
    all.insert(MANIFEST.to_owned(), manifest(&new()));
    let mut entries = Vec::new();
    for (name, bytes) in &all {
        fs::write(paths.new_file(name), bytes).unwrap();
        let mut entry = Entry::of(name, bytes);
        entry.replace = name != "same";
        entries.push(entry);
    }
    let journal = Journal::new(entries);
    journal.write(&paths).unwrap();
    (folder, paths, journal)
}

/// A step as it is where there are no hard links.
fn without_links(step: Step<'_>, paths: &Paths, folder: &Path) {
    match step {
        Step::Save(name) if folder.join(name).exists() => {
            fs::rename(folder.join(name), paths.old_folder().join(name)).unwrap();
        }
        step => step.run(paths).unwrap(),
    }
}

#[test]
fn a_run_that_is_killed_after_any_step_is_finished_by_the_next() {
    let count = prepared().2.forwards().len();
    assert_eq!(count, 11, "three files, of which one is new, and the manifest");
    for links in [true, false] {
        for killed in 0..=count {
            let (folder, paths, journal) = prepared();
            let when = format!("killed before step {killed}, links: {links}");
            for step in &journal.forwards()[..killed] {
                if links { step.run(&paths).unwrap() } else { without_links(*step, &paths, folder.path()) }
            }
            assert_honest(folder.path(), &when);
            let (transaction, recovered) = begin(folder.path());
            assert_eq!(recovered, Some(Recovery::Finished), "{when}");
            drop(transaction);
            assert_eq!(held(folder.path()), both(), "{when}");
        }
    }
}

#[test]
fn a_run_that_is_killed_while_it_rolls_back_is_finished_too() {
    let (forwards, backwards) = {
        let (_folder, _, journal) = prepared();
        (journal.forwards().len(), journal.backwards().len())
    };
    for failed in 0..forwards {
        for killed in 0..=backwards {
            let (folder, paths, journal) = prepared();
            let when = format!("failed at step {failed}, killed before step {killed} backwards");
            journal.forwards()[..failed].iter().for_each(|step| step.run(&paths).unwrap());
            journal.backwards()[..killed].iter().for_each(|step| step.run(&paths).unwrap());
            assert_honest(folder.path(), &when);
            if killed == backwards {
                let visible: Files = before()
                    .keys()
                    .map(|n| (n.clone(), fs::read(folder.path().join(n)).unwrap_or_default()))
                    .collect();
                assert_eq!(visible, before(), "{when}");
                assert!(!folder.path().join("c").exists(), "{when}");
            }
            assert_eq!(recover(&paths).unwrap(), Some(Recovery::Finished), "{when}");
            assert_eq!(held(folder.path()), both(), "{when}");
        }
    }
}

#[test]
fn a_killed_run_whose_new_files_are_lost_is_rolled_back() {
    for killed in 0..prepared().2.forwards().len() {
        let (folder, paths, journal) = prepared();
        journal.forwards()[..killed].iter().for_each(|step| step.run(&paths).unwrap());
        // the last file of the list: still staged, or in place
        let lost = if paths.new_file("c").exists() { paths.new_file("c") } else { paths.target("c") };
        fs::write(lost, b"half").unwrap();
        let done = recover(&paths).unwrap();
        if paths.target(MANIFEST).exists() && held(folder.path())[MANIFEST] == manifest(&new()) {
            // it had its manifest: what changed afterwards is not for this program to judge
            assert_eq!(done, Some(Recovery::Finished));
            continue;
        }
        assert_eq!(done, Some(Recovery::RolledBack), "killed before step {killed}");
        assert_eq!(held(folder.path()), before(), "killed before step {killed}");
    }
}

#[test]
fn what_was_staged_without_a_journal_is_removed() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &old()).unwrap();
    let transaction = staged(folder.path(), &new());
    fs::write(folder.path().join(STAGING).join("journal.draft"), b"{").unwrap();
    // as a killed process: nothing is dropped but the lock
    let copy = tempfile::tempdir().unwrap();
    let killed = copy.path().join("killed");
    fs::rename(folder.path().join(STAGING), &killed).unwrap();
    drop(transaction);
    fs::rename(&killed, folder.path().join(STAGING)).unwrap();
    assert_honest(folder.path(), "while staged");
    let (transaction, recovered) = begin(folder.path());
    assert_eq!(recovered, Some(Recovery::Discarded));
    drop(transaction);
    assert_eq!(held(folder.path()), before());
}

#[test]
fn a_run_that_is_killed_while_it_clears_up_has_done_its_work() {
    let (folder, paths, journal) = prepared();
    journal.carry_out(&paths).unwrap();
    fs::remove_file(paths.journal()).unwrap();
    fs::remove_dir_all(paths.new_folder()).unwrap();
    assert_eq!(recover(&paths).unwrap(), Some(Recovery::Discarded));
    assert_eq!(held(folder.path()), both());
}

#[test]
fn an_error_at_any_file_puts_everything_back() {
    for name in ["a", "b", "c"] {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), &old()).unwrap();
        let transaction = staged(folder.path(), &new());
        // it came while the tables were baked
        let path = folder.path().join(name);
        let _ = fs::remove_file(&path);
        fs::create_dir(&path).unwrap();
        let error = transaction.commit(&manifest(&new())).unwrap_err();
        assert!(matches!(&error, TransactionError::Replace { path: p, .. } if *p == path), "{name}: {error}");
        fs::remove_dir(&path).unwrap();
        let mut left = before();
        left.remove(name);
        assert_eq!(held(folder.path()), left, "{name}");
    }
}

#[test]
fn a_transaction_that_is_dropped_or_cancelled_leaves_no_trace() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x/y");
    drop(staged(&path, &new()));
    assert!(!folder.path().join("x").exists(), "folders that were made are removed");
    write(folder.path(), &old()).unwrap();
    let stop = Cancel::new();
    let waiting = Waiting { timeout: Duration::ZERO, told: &|| {} };
    let (mut transaction, _) = Transaction::begin(folder.path(), &[], &stop, &waiting).unwrap();
    new().iter().for_each(|(name, bytes)| transaction.stage(name, bytes).unwrap());
    stop.set();
    assert!(matches!(transaction.commit(&manifest(&new())), Err(TransactionError::Cancelled)));
    assert_eq!(held(folder.path()), before());
}

#[test]
fn files_with_the_same_bytes_are_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    let counts = |files: &Files| write(folder.path(), files).map(|w| (w.written, w.unchanged)).unwrap();
    assert_eq!(counts(&old()), (5, 0));
    let time = |name: &str| fs::metadata(folder.path().join(name)).unwrap().modified().unwrap();
    let times = [time("a"), time(MANIFEST)];
    assert_eq!(counts(&old()), (0, 5));
    assert_eq!([time("a"), time(MANIFEST)], times);
    assert_eq!(counts(&new()), (4, 1));
    // a file that was damaged is written again, under the manifest that it was written with
    fs::write(folder.path().join("b"), b"hurt").unwrap();
    assert_eq!(counts(&new()), (1, 4));
    assert_eq!(held(folder.path()), both());
}

#[cfg(unix)]
#[test]
fn who_has_a_file_open_keeps_what_it_opened() {
    use std::io::Read;
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), &old()).unwrap();
    let mut readers = ["a", MANIFEST].map(|name| File::open(folder.path().join(name)).unwrap());
    write(folder.path(), &new()).unwrap();
    for (reader, text) in readers.iter_mut().zip([b"old a".to_vec(), manifest(&old())]) {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes, text, "replaced, not overwritten");
    }
    // and the new ones have the usual permissions
    fs::write(folder.path().join("usual"), b"").unwrap();
    let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode();
    assert_eq!(mode("a"), mode("usual"));
}

#[test]
fn a_locked_folder_is_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let (first, _) = begin(folder.path());
    let told = std::sync::atomic::AtomicUsize::new(0);
    let count = || {
        told.fetch_add(1, Ordering::Relaxed);
    };
    let waiting = |ms| Waiting { timeout: Duration::from_millis(ms), told: &count };
    let again = Transaction::begin(folder.path(), &[], &GO, &waiting(100));
    assert!(matches!(again, Err(TransactionError::Busy { .. })), "{again:?}");
    assert_eq!(told.swap(0, Ordering::Relaxed), 1, "told once");
    assert!(matches!(
        Transaction::begin(folder.path(), &[], &GO, &waiting(0)),
        Err(TransactionError::Busy { .. })
    ));
    assert_eq!(told.load(Ordering::Relaxed), 0, "nothing is waited for");
    let stop = Cancel::new();
    stop.set();
    let again = Transaction::begin(folder.path(), &[], &stop, &waiting(60_000));
    assert!(matches!(again, Err(TransactionError::Cancelled)), "{again:?}");
    drop(first);
    assert!(Transaction::begin(folder.path(), &[], &GO, &waiting(0)).is_ok());
}

#[test]
fn writers_at_once_do_not_mix() {
    // the folder is made and removed by whoever comes, too
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("out");
    std::thread::scope(|scope| {
        for writer in 0..4 {
            let folder = &folder;
            scope.spawn(move || {
                for round in 0..25 {
                    let text = format!("{writer} {round}");
                    let mine: Files = (0..6).map(|i| (format!("f{i}"), text.clone().into_bytes())).collect();
                    if round % 5 == writer {
                        drop(staged(folder, &mine));
                    } else {
                        write(folder, &mine).unwrap();
                    }
                }
            });
        }
    });
    let last = held(&folder);
    assert_eq!(last.len(), 7);
    assert_honest(&folder, "at the end");
    assert!((1..6).all(|i| last[&format!("f{i}")] == last["f0"]));
}

#[test]
fn a_journal_that_is_not_understood_is_left_alone() {
    let text = |schema: u32, name: &str| {
        format!(
            r#"{{"schema": {schema}, "files": [{{"name": "{name}", "bytes": 1, "blake3": "", "replace": true}}]}}"#
        )
    };
    for (text, fault) in [
        (text(9, "a"), "schema 9"),
        (text(1, "../a"), "no file name"),
        (text(1, "/a"), "no file name"),
        ("{".to_owned(), "EOF"),
    ] {
        let (folder, paths, _) = prepared();
        fs::write(paths.journal(), text).unwrap();
        let error = recover(&paths).unwrap_err().to_string();
        assert!(error.contains(fault), "{fault}: {error}");
        assert!(paths.new_file("a").exists() && folder.path().join("a").exists());
    }
}

#[test]
fn conflicts_are_found_before() {
    let folder = tempfile::tempdir().unwrap();
    let names = |list: &[&str]| list.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
    let fault = |folder: &Path, list: &[&str]| check(folder, &names(list)).unwrap_err().to_string();
    fs::create_dir(folder.path().join("a.exr")).unwrap();
    fs::write(folder.path().join("file"), b"").unwrap();
    assert!(fault(folder.path(), &["b.exr", "a.exr"]).contains("there is a folder of this name"));
    assert!(fault(folder.path(), &["b.exr", "B.exr"]).contains("b.exr and B.exr"));
    assert!(fault(&folder.path().join("file"), &["b"]).contains("there is a file of this name"));
    assert!(
        fault(&folder.path().join("file/x/y"), &["b"]).contains("file cannot be written: there is a file")
    );
    assert!(check(folder.path(), &names(&["b.exr", "file"])).is_ok());
    assert!(check(&folder.path().join("not/there"), &names(&["b.exr"])).is_ok());
}

#[cfg(unix)]
#[test]
fn links_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    let link = |to: &str, name: &str| std::os::unix::fs::symlink(path(to), path(name)).unwrap();
    let fault = |name: &str| check(folder.path(), &[name.to_owned()]).map_err(|e| e.to_string());
    link("nowhere", "dangling");
    link("elsewhere", "linked");
    fs::create_dir(path("folder")).unwrap();
    link("folder", "to-folder");
    fs::write(path("elsewhere"), b"kept").unwrap();
    assert!(fault("dangling").unwrap_err().contains("a link that leads nowhere"));
    assert!(fault("to-folder").unwrap_err().contains("a link to a folder"));
    assert!(check(&path("dangling"), &[]).unwrap_err().to_string().contains("leads nowhere"));
    assert!(check(&path("dangling/x"), &[]).is_err());
    std::os::unix::fs::symlink("/dev/null", path("device")).unwrap();
    assert!(fault("device").unwrap_err().contains("what is no file"));
    // a link to a file is replaced, and what it leads to is left alone
    fault("linked").unwrap();
    write(folder.path(), &files(&[("linked", "new")])).unwrap();
    assert_eq!(fs::read(path("linked")).unwrap(), b"new");
    assert_eq!(fs::read(path("elsewhere")).unwrap(), b"kept");
    // and comes back if the run fails
    fs::remove_file(path("linked")).unwrap();
    link("elsewhere", "linked");
    let transaction = staged(folder.path(), &files(&[("linked", "new"), ("then", "new")]));
    fs::create_dir(path("then")).unwrap();
    assert!(transaction.commit(b"{}").is_err());
    assert_eq!(fs::read_link(path("linked")).unwrap(), path("elsewhere"));
}
