//! Markdown as plain text for a terminal. Not a renderer: pages are written to be read as they are, so only what a terminal
//! reader has no use for is changed. Comments, pictures and the marks of fences go, links keep their text, tables are set.

/// Widest line of a table that is set in columns; wider ones are set row by row.
const WIDTH: usize = 100;

/// A page as text for the terminal.
#[must_use]
pub fn plain(markdown: &str) -> String {
    let mut text = String::new();
    let mut lines = markdown.lines().peekable();
    let mut code = false;
    while let Some(line) = lines.next() {
        if line.starts_with("```") {
            code = !code;
        } else if code {
            text.push_str(&format!("    {line}\n"));
        } else if line.starts_with('|') {
            let mut rows = vec![cells(line)];
            while let Some(row) = lines.next_if(|l| l.starts_with('|')) {
                rows.push(cells(row));
            }
            text.push_str(&table(&rows));
        } else if line.starts_with("<!--") {
            // a marker stands between a paragraph and a table: no line of its own
        } else if let Some(title) = line.strip_prefix("# ") {
            text.push_str(&format!("{title}\n{}\n", "=".repeat(title.chars().count())));
        } else if let Some(title) = line.strip_prefix("## ") {
            text.push_str(&format!("{title}\n{}\n", "-".repeat(title.chars().count())));
        } else if line.starts_with("###") {
            text.push_str(&format!("{}\n", line.trim_start_matches('#').trim_start()));
        } else {
            let shown = inline(line);
            // a line of pictures leaves nothing
            if !shown.trim().is_empty() || line.trim().is_empty() {
                text.push_str(&hang("", &shown));
            }
        }
    }
    squeeze(&text)
}

/// A line without `**`, without pictures, and with the text of its links.
fn inline(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some(at) = rest.find('[') {
        let link = rest[at..].split_once("](").filter(|(label, _)| !label[1..].contains(['[', ']', '`']));
        let Some((label, (target, behind))) = link.and_then(|(l, r)| r.split_once(')').map(|r| (l, r)))
        else {
            out.push_str(&rest[..=at]);
            rest = &rest[at + 1..];
            continue;
        };
        let picture = rest[..at].ends_with('!');
        out.push_str(rest[..at].trim_end_matches(if picture { "!" } else { "" }));
        if !picture {
            out.push_str(&label[1..]);
            if target.starts_with("http") {
                out.push_str(&format!(" ({target})"));
            }
        }
        rest = behind;
    }
    out.push_str(rest);
    out.replace("**", "")
}

fn cells(line: &str) -> Vec<String> {
    line.trim_matches('|').split('|').map(|c| inline(c.trim())).collect()
}

/// In columns if that is narrow enough; else as a list of terms if there are two columns; else a row is a block, with the head of
/// the column before each cell.
fn table(rows: &[Vec<String>]) -> String {
    let is_rule = |row: &[String]| row.iter().all(|c| !c.is_empty() && c.chars().all(|c| "-:".contains(c)));
    let rows: Vec<&Vec<String>> = rows.iter().filter(|r| !is_rule(r)).collect();
    let columns = rows.iter().map(|r| r.len()).max().unwrap_or(0);
    let long = |text: &str| text.chars().count();
    let widths: Vec<usize> = (0..columns)
        .map(|i| rows.iter().filter_map(|r| r.get(i)).map(|c| long(c)).max().unwrap_or(0))
        .collect();
    let mut text = String::new();
    if widths.iter().sum::<usize>() + 2 * columns <= WIDTH {
        for (n, row) in rows.iter().enumerate() {
            let line: String =
                row.iter().zip(&widths).map(|(c, w)| format!("{c}{}", " ".repeat(w - long(c) + 2))).collect();
            text.push_str(&format!("{}\n", line.trim_end()));
            if n == 0 {
                let rule: Vec<String> = widths.iter().map(|w| "-".repeat(*w)).collect();
                text.push_str(&format!("{}\n", rule.join("  ")));
            }
        }
        return text;
    }
    let Some((heads, rows)) = rows.split_first() else { return text };
    if columns == 2 {
        let key = widths.first().copied().unwrap_or(0).min(WIDTH / 3);
        for row in rows {
            let cell = |i: usize| row.get(i).map_or("", String::as_str);
            text.push_str(&hang(&format!("{:key$}  ", cell(0)), cell(1)));
        }
        return text;
    }
    let head = heads.iter().map(|h| long(h)).max().unwrap_or(0).min(WIDTH / 4);
    for row in rows {
        for (i, cell) in row.iter().enumerate().filter(|(_, c)| !c.is_empty()) {
            if i == 0 {
                text.push_str(&format!("{cell}\n"));
            } else {
                let name = heads.get(i).map_or("", String::as_str);
                text.push_str(&hang(&format!("  {name:head$}  "), cell));
            }
        }
    }
    text
}

/// A text behind a label, broken at spaces, with the later lines below the first.
fn hang(label: &str, cell: &str) -> String {
    let indent = label.chars().count();
    let mut lines = vec![label.to_owned()];
    let mut used = indent;
    for word in cell.split(' ') {
        let length = word.chars().count();
        if used > indent && used + 1 + length > WIDTH {
            lines.push(" ".repeat(indent));
            used = indent;
        }
        if let Some(line) = lines.last_mut() {
            if used > indent {
                line.push(' ');
                used += 1;
            }
            line.push_str(word);
            used += length;
        }
    }
    lines.iter().map(|l| format!("{}\n", l.trim_end())).collect()
}

/// No two empty lines together, none at either end.
fn squeeze(text: &str) -> String {
    let mut out: Vec<&str> = Vec::new();
    for line in text.trim_matches('\n').lines() {
        if !line.is_empty() || out.last().is_some_and(|l| !l.is_empty()) {
            out.push(line);
        }
    }
    out.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn what_a_terminal_has_no_use_for_goes() {
        let page = "# Title\n\n![a](b.png) ![c](d.png)\n\n<!-- generated: x -->\nSee **this** [page](p.md) and [site](https://x.org), \
                    but `[0](1)`.\n\n## Part\n```sh\n# kept\nrun\n```\n";
        assert_eq!(
            plain(page),
            "Title\n=====\n\nSee this page and site (https://x.org), but `0`.\n\nPart\n----\n    # kept\n    run\n"
        );
    }

    #[test]
    fn brackets_of_formulas_stay() {
        assert_eq!(plain("x in [0, 1], M = [[r, 0], [g, a]](t)\n"), "x in [0, 1], M = [[r, 0], [g, a]](t)\n");
        assert_eq!(plain("`[[table]]` and [a] (b)\n"), "`[[table]]` and [a] (b)\n");
    }

    #[test]
    fn narrow_tables_are_set_in_columns_and_wide_ones_in_blocks() {
        assert_eq!(plain("| a | b |\n|---|---|\n| long | c |\n"), "a     b\n----  -\nlong  c\n");
        let long = "word ".repeat(30);
        let wide = |columns: &str| plain(&format!("{columns} {} |\n", long.trim()));
        let three = wide("| id | n | what |\n|---|---|---|\n| x | 1 |");
        assert!(three.starts_with("x\n  n     1\n  what  word word"), "{three}");
        let two = wide("| id | what |\n|---|---|\n| x |");
        assert!(two.starts_with("x   word word"), "{two}");
        let lines = |text: &str| text.lines().map(str::len).collect::<Vec<_>>();
        assert!(lines(&three).iter().chain(&lines(&two)).all(|l| *l <= super::WIDTH), "{three}{two}");
        assert_eq!((lines(&three).len(), lines(&two).len()), (4, 2));
    }
}
