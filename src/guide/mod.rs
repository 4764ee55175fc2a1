//! The guide: one page a topic, read in the terminal (`brdfbake guide TOPIC`) and here.
//!
//! A page is `src/guide/TOPIC.md` and one line in the list below; its title is its first heading. Tables between the markers
//! `<!-- generated: NAME -->` and `<!-- end: NAME -->` are written from the registries by `cargo bless --test house readme`, and a test
//! fails where they are stale. The page of an engine is derived from its entry ([`engine_page`]).

mod engine;
mod plain;

pub use engine::engine_page;
pub use plain::plain;

/// A page of the guide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Topic {
    /// Id: the file name without `.md`.
    pub id: &'static str,
    /// The page, in Markdown.
    pub text: &'static str,
}

impl Topic {
    /// What the page is about: its first heading.
    #[must_use]
    pub fn title(&self) -> &'static str {
        self.text.lines().next().unwrap_or_default().trim_start_matches("# ")
    }
}

macro_rules! topics {
    ($($id:ident)*) => {
        $(
            #[doc = include_str!(concat!(stringify!($id), ".md"))]
            pub mod $id {}
        )*
        /// Every page, in the order in which a newcomer reads them.
        pub static TOPICS: &[Topic] = &[
            $(Topic { id: stringify!($id), text: include_str!(concat!(stringify!($id), ".md")) }),*
        ];
    };
}

topics! {
    command
    recipes
    tables
    models
    axes
    formats
    engines
    scenes
    writing
    maps
    conventions
    accuracy
    reports
    stability
    checking
    shipped
    laws
    formulas
    numbers
    building
    extending
    changelog
}

/// Finds a page by its id.
#[must_use]
pub fn topic(id: &str) -> Option<&'static Topic> {
    TOPICS.iter().find(|t| t.id == id)
}
