//! Requests to a plan.

use super::fault::Fault;
use super::faults::Faults;
use super::place::{Path, Place};
use super::request::{Draft, TableRequest};
use super::table::{self, PlannedTable};
use super::{MANIFEST, MAX_TABLES, identity, name};
use serde_json::{Value as Json, json};
use std::collections::HashSet;

/// What to bake, checked: every name is known, every number in its range, every table bound.
#[derive(Debug)]
pub struct Plan {
    /// Its name: that of the recipe.
    pub name: String,
    /// The tables, in the order in which they were asked for.
    pub tables: Vec<PlannedTable>,
    /// Hash over its name and the identities of its tables, in hex.
    pub hash: String,
    /// Why its tables were asked for, as the manifest tells it: what scenes need. Nothing of it is in a file of a table.
    pub reasons: Option<Json>,
}

/// Why requests make no plan: every fault with its place, such as `table[0].outputs[1]`.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanError {
    /// Places and faults, in the order of the requests.
    pub faults: Vec<(Place, Fault)>,
}

impl std::fmt::Display for PlanError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (place, fault)) in self.faults.iter().enumerate() {
            write!(f, "{}{place}: {fault}", if i > 0 { "\n" } else { "" })?;
            for more in [fault.allowed(), fault.remedy()].into_iter().flatten() {
                write!(f, "; {more}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for PlanError {}

impl Plan {
    /// Resolves requests, by the same rules for every asker.
    ///
    /// # Errors
    /// [`PlanError`] with every fault.
    pub fn from_requests(name: &str, tables: Vec<TableRequest>) -> Result<Plan, PlanError> {
        let mut faults = Faults::default();
        check_count(tables.len(), &mut faults);
        let drafts = tables.into_iter().take(MAX_TABLES).map(Draft::from).collect();
        match resolve(Some(name), None, drafts, &mut faults) {
            Some(plan) if faults.is_empty() => Ok(plan),
            _ => Err(PlanError { faults: faults.list }),
        }
    }

    /// A plan of no table: who asks needs none, and the manifest says so.
    #[must_use]
    pub fn nothing(name: &str) -> Plan {
        Plan::new(name, Vec::new())
    }

    /// The plan with the reasons of its tables.
    #[must_use]
    pub fn because(mut self, reasons: Json) -> Plan {
        self.reasons = Some(reasons);
        self
    }

    /// The plan without the tables that `keep` is false for, in order. Their identities stay: they are those of the whole plan.
    #[must_use]
    pub fn only(mut self, keep: impl Fn(&PlannedTable) -> bool) -> Plan {
        self.tables.retain(keep);
        self
    }

    /// One plan with the tables of several, in order.
    ///
    /// # Errors
    /// [`PlanError`] if there are no tables, too many, or two of the same name.
    pub fn join(name: &str, plans: Vec<Plan>) -> Result<Plan, PlanError> {
        let tables: Vec<PlannedTable> = plans.into_iter().flat_map(|p| p.tables).collect();
        let mut faults = Faults::default();
        check_count(tables.len(), &mut faults);
        let mut taken = HashSet::new();
        for (i, table) in tables.iter().enumerate() {
            if !taken.insert(table.name().to_ascii_lowercase()) {
                let (got, why) = (table.name().to_owned(), "two plans have it".to_owned());
                let fault = Fault::Twice { what: "table name", got, why };
                faults.value(Path::table(i).key("name"), fault);
            }
        }
        if faults.is_empty() { Ok(Plan::new(name, tables)) } else { Err(PlanError { faults: faults.list }) }
    }

    /// A plan of tables that are resolved and go together; they get their identities as parts of it.
    fn new(name: &str, tables: Vec<PlannedTable>) -> Plan {
        let tables: Vec<PlannedTable> = tables.into_iter().map(|t| t.identified(name)).collect();
        let hash = identity::of_plan(name, &tables);
        Plan { name: name.to_owned(), tables, hash, reasons: None }
    }

    /// Name and tables under the keys of a recipe, with all defaults filled in; the same for requests that mean the same.
    #[must_use]
    pub fn canonical(&self) -> Json {
        json!({ "name": self.name, "table": self.tables.iter().map(PlannedTable::canonical).collect::<Vec<_>>() })
    }

    /// What was asked for, table by table, with all defaults filled in. As requests, or as the text of a recipe, they make the same
    /// plan again.
    #[must_use]
    pub fn requests(&self) -> Vec<TableRequest> {
        self.tables.iter().map(|t| t.asked.clone()).collect()
    }

    /// Names of every file that it writes, in order, relative to the output folder, the manifest last. One that tables share by its name
    /// is there once; one that is there twice is a conflict, which the pipeline finds.
    #[must_use]
    pub fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for table in &self.tables {
            let shared = |name: &String| table.asked.file.is_some() && names.contains(name);
            let own: Vec<String> = table.files().into_iter().filter(|name| !shared(name)).collect();
            names.extend(own);
        }
        names.push(MANIFEST.to_owned());
        names
    }
}

/// A plan has tables, and not too many.
pub(crate) fn check_count(count: usize, faults: &mut Faults) {
    if count == 0 || count > MAX_TABLES {
        let allowed = format!("1 to {MAX_TABLES}");
        faults.key(Path::root().key("table"), Fault::Count { key: "table", got: count, allowed });
    }
}

/// Resolves requests as they could be read. `tolerance` is that of tables without one. None if a part is missing; the faults say which.
pub(crate) fn resolve(
    name: Option<&str>,
    tolerance: Option<f64>,
    drafts: Vec<Draft>,
    faults: &mut Faults,
) -> Option<Plan> {
    if let Some(fault) = name.and_then(name::recipe) {
        faults.value(Path::root().key("name"), fault);
    }
    table::check_tolerance(tolerance, Path::root().key("tolerance"), faults);
    name::files(&drafts, faults);
    let mut taken = HashSet::new();
    let mut tables = Vec::new();
    for (i, draft) in drafts.into_iter().enumerate() {
        let path = Path::table(i);
        name::check(&draft, &path, &mut taken, faults);
        tables.push(table::resolve(draft, &path, tolerance, faults));
    }
    let tables: Vec<PlannedTable> = tables.into_iter().collect::<Option<_>>()?;
    Some(Plan::new(name?, tables))
}
