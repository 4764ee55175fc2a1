//! The nearest of a few words, for "did you mean".

/// The candidate with the least edit distance to `word`, if it is near enough to be a slip (a third of the length).
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let limit = 1 + word.chars().count() / 3;
    candidates
        .into_iter()
        .map(|c| (distance(word, c), c))
        .filter(|(d, _)| *d <= limit)
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

/// The end of a message about an unknown word: `; did you mean ...?`, or nothing where no candidate is near.
pub fn hint<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, candidates).map_or_else(String::new, |n| format!("; did you mean `{n}`?"))
}

/// Up to `most` candidates that are near enough to `word` to be slips, nearest first.
pub fn few<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>, most: usize) -> Vec<&'a str> {
    let limit = 1 + word.chars().count() / 3;
    let mut near: Vec<(usize, &str)> =
        candidates.into_iter().map(|c| (distance(word, c), c)).filter(|(d, _)| *d <= limit).collect();
    near.sort_by_key(|(d, _)| *d);
    near.into_iter().take(most).map(|(_, c)| c).collect()
}

/// Levenshtein distance, case ignored, with `-` and `_` alike.
fn distance(a: &str, b: &str) -> usize {
    let fold = |s: &str| s.to_lowercase().replace('_', "-").chars().collect::<Vec<char>>();
    let (a, b) = (fold(a), fold(b));
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let cost = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = cost.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
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
    }
}
