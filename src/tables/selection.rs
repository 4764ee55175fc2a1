//! Which channels a table holds: a named layout, or any channels of the kind in any order.

use super::spec::{BindError, unknown};
use super::{ChannelInfo, Layout, TableInfo};
use crate::integrate::MAX_CHANNELS;

/// What [`Selection::id`] is where the channels make no layout.
pub const CUSTOM: &str = "channels";

/// The channels of a table in file order.
///
/// A baker that looks at the ids of the channels, one by one, serves layouts and free choices alike; `id` is for words.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Id of the layout that the channels make, or [`CUSTOM`].
    pub id: &'static str,
    /// What the layout means to a shader; empty for a free choice.
    pub doc: &'static str,
    /// The channels: 1 to [`MAX_CHANNELS`], none twice.
    pub channels: Vec<ChannelInfo>,
}

impl Selection {
    /// True for channels that make no layout of the kind.
    #[must_use]
    pub fn is_custom(&self) -> bool {
        self.id == CUSTOM
    }

    /// Ids of the channels, in file order.
    pub fn ids(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.channels.iter().map(|c| c.id)
    }

    /// `layout scale-bias: specular = ...`, or `channels dfg.scale, dfg.f82`.
    #[must_use]
    pub fn title(&self) -> String {
        if self.is_custom() {
            return format!("channels {}", self.ids().collect::<Vec<_>>().join(", "));
        }
        format!("layout {}: {}", self.id, self.doc)
    }

    /// The channels that a request names: those of the layout `id` (the first one if none), or `channels` themselves.
    /// Channels that make a layout are that layout.
    pub(super) fn resolve(
        kind: &'static TableInfo,
        id: Option<&str>,
        channels: Option<&[String]>,
    ) -> Result<Selection, BindError> {
        let Some(channels) = channels else {
            return Ok(Selection::from(match id {
                None => &kind.layouts[0],
                Some(id) => kind
                    .layouts
                    .iter()
                    .find(|l| l.id == id)
                    .ok_or_else(|| unknown("layout", id, kind.layouts.iter().map(|l| l.id)))?,
            }));
        };
        if id.is_some() {
            return Err(BindError::LayoutAndChannels { kind: kind.id });
        }
        let chosen = choose(kind, channels)?;
        let same = |l: &&Layout| l.channels.iter().map(|c| c.id).eq(chosen.iter().map(|c| c.id));
        let layout = kind.layouts.iter().find(same);
        if layout.is_none() && matches!(kind.mix, super::Mix::Layouts) {
            return Err(BindError::NoMix { kind: kind.id });
        }
        Ok(layout
            .map_or_else(|| Selection { id: CUSTOM, doc: "", channels: chosen.clone() }, Selection::from))
    }
}

impl From<&Layout> for Selection {
    fn from(layout: &Layout) -> Selection {
        Selection { id: layout.id, doc: layout.doc, channels: layout.channels.to_vec() }
    }
}

fn choose(kind: &'static TableInfo, ids: &[String]) -> Result<Vec<ChannelInfo>, BindError> {
    let pool = kind.pool();
    let mut chosen: Vec<ChannelInfo> = Vec::new();
    for id in ids {
        let channel = pool
            .iter()
            .find(|c| c.id == id)
            .ok_or_else(|| unknown("channel", id, pool.iter().map(|c| c.id)))?;
        if chosen.iter().any(|c| c.id == id) {
            return Err(BindError::ChannelTwice { got: id.clone() });
        }
        chosen.push(*channel);
    }
    if chosen.is_empty() || chosen.len() > MAX_CHANNELS {
        return Err(BindError::ChannelCount { kind: kind.id, got: chosen.len(), max: MAX_CHANNELS });
    }
    Ok(chosen)
}
