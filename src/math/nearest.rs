//! The nearest of a few words, for "did you mean".

/// Edits that a slip of a word has at most: one in three letters.
fn limit(word: &str) -> usize {
    (word.chars().count() / 3).max(1)
}

/// The candidate with the least edit distance to `word`, if it is near enough to be a slip (a third of the length).
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let limit = limit(word);
    candidates
        .into_iter()
        .map(|c| (slips(word, c), c))
        .filter(|(d, _)| *d <= limit)
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

/// The end of a message about an unknown word: `; did you mean ...?`, or nothing where no candidate is near.
pub fn hint<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, candidates).map_or_else(String::new, |n| format!("; did you mean `{n}`?"))
}

/// The end of a message about an unknown word: `; did you mean ...?`, or all candidates where none is near.
pub fn offer<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str> + Clone) -> String {
    let all = || candidates.clone().into_iter().collect::<Vec<_>>().join(", ");
    nearest(word, candidates.clone())
        .map_or_else(|| format!("; there is {}", all()), |n| format!("; did you mean `{n}`?"))
}

/// Up to `most` candidates that are near enough to `word` to be slips, nearest first.
pub fn few<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>, most: usize) -> Vec<&'a str> {
    let limit = limit(word);
    let mut near: Vec<(usize, &str)> =
        candidates.into_iter().map(|c| (slips(word, c), c)).filter(|(d, _)| *d <= limit).collect();
    near.sort_by_key(|(d, _)| *d);
    near.into_iter().take(most).map(|(_, c)| c).collect()
}

/// Edits that make a slip of a word; a word that was not written to its end is one.
fn slips(word: &str, candidate: &str) -> usize {
    let begun = word.chars().count() > 3 && candidate.to_lowercase().starts_with(&word.to_lowercase());
    if begun { 1 } else { distance(word, candidate) }
}

/// Edits between two words: a letter more, less or another, or two neighbours swapped. Case is ignored, `-` and `_` are alike.
fn distance(a: &str, b: &str) -> usize {
    let fold = |s: &str| s.to_lowercase().replace('_', "-").chars().collect::<Vec<char>>();
    let (a, b) = (fold(a), fold(b));
    // rows of the prefixes of `a` that end two letters, one letter, and no letter before
    let (mut before, mut last): (Vec<usize>, Vec<usize>) = (Vec::new(), (0..=b.len()).collect());
    for (i, x) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, y) in b.iter().enumerate() {
            let replaced = last[j] + usize::from(x != y);
            let mut least = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && *x == b[j - 1] && a[i - 1] == *y {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn finds_slips_and_nothing_else() {
        let words = ["length", "warp", "texel"];
        assert_eq!(nearest("lenght", words), Some("length"));
        assert_eq!(nearest("Warp", words), Some("warp"));
        assert_eq!(nearest("colour", words), None);
        assert_eq!(nearest("foo", ["eon", "fog"]), Some("fog"));
        assert_eq!(nearest("foo", ["eon"]), None);
        assert_eq!(nearest("descend", ["ascending", "descending"]), Some("descending"));
        assert_eq!(nearest("gxg", ["ggx", "gtr"]), Some("ggx"));
        assert_eq!(nearest("alhpa", ["f0", "alpha"]), Some("alpha"));
    }
}
