//! How the error of a table falls with evaluations, for the baker's rule and for the samplers of others; and with time.

use super::colour::uri;
use super::facts::scroll;
use super::view::{Convergence, View};
use crate::math::figures::{short, significant};
use crate::report::chart::Chart as Picture;
use crate::report::converge;
use maud::{Markup, html};

/// Error against evaluations, or why it is not drawn.
pub(super) fn chart(view: &View) -> Markup {
    let chart = match &view.convergence {
        Ok(c) => &c.chart,
        Err(why) => return html! { p.note { "Error against evaluations is not drawn: " (why) } },
    };
    let reached: Vec<String> = chart
        .series
        .iter()
        .map(|s| {
            let least = s.points.last().map_or(f64::NAN, |p| p.largest);
            let at = s.points.last().map_or(f64::NAN, |p| p.evaluations);
            format!("{}: {} at {}", s.title, significant(least, 2), significant(at, 3))
        })
        .collect();
    html! {
        (drawn("error against evaluations", &converge::chart(chart)))
        p.note {
            "Largest error of " (chart.texels) " seeded texels over evaluations of a texel, against the baker's rule at its finest (its own error: "
            (short(chart.reference)) "). Smallest errors: " (reached.join("; ")) "."
        }
    }
}

/// Error against time, if that is to be shown.
pub(super) fn times(convergence: &Convergence) -> Option<Markup> {
    let times = convergence.times.as_ref()?;
    Some(drawn("error against time", &converge::time_chart(&convergence.chart, times)))
}

fn drawn(what: &str, picture: &Picture) -> Markup {
    let name = format!("{}: {what}", picture.title);
    let curves = picture.curves.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join("; ");
    scroll(
        &name,
        html! {
            figure.chart {
                img src=(uri("image/svg+xml", picture.svg().as_bytes())) width="960" height="600" alt=(format!("{name}; curves: {curves}"));
            }
        },
    )
}
