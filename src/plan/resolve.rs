//! Requests to a plan.

use super::fault::Fault;
use super::faults::Faults;
use super::map::{self, MapDraft, MapRequest, PlannedMap};
use super::place::{Path, Place};
use super::request::{Draft, TableRequest};
use super::table::{self, PlannedTable};
use super::{MANIFEST, MAX_TABLES, identity, name};
use serde_json::{Value as Json, json};
use std::collections::HashSet;

/// What to bake, checked: every name is known, every number in its range, every table bound, every image found.
#[derive(Debug)]
pub struct Plan {
    /// Its name: that of the recipe.
    pub name: String,
    /// The tables, in the order in which they were asked for.
    pub tables: Vec<PlannedTable>,
    /// The maps, in the order in which they were asked for.
    pub maps: Vec<PlannedMap>,
    /// Hash over its name and the identities of its tables and maps, in hex.
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
        Plan::from_all(name, tables, Vec::new())
    }

    /// As [`Plan::from_requests`], with maps.
    ///
    /// # Errors
    /// [`PlanError`] with every fault.
    pub fn from_all(name: &str, tables: Vec<TableRequest>, maps: Vec<MapRequest>) -> Result<Plan, PlanError> {
        let mut faults = Faults::default();
        check_count([tables.len(), maps.len()], &mut faults);
        let tables = tables.into_iter().take(MAX_TABLES).map(Draft::from).collect();
        let maps = maps.into_iter().take(MAX_TABLES).map(MapDraft::from).collect();
        match resolve(Some(name), None, tables, maps, &mut faults) {
            Some(plan) if faults.is_empty() => Ok(plan),
            _ => Err(PlanError { faults: faults.list }),
        }
    }

    /// A plan of no table: who asks needs none, and the manifest says so.
    #[must_use]
    pub fn nothing(name: &str) -> Plan {
        Plan::new(name, Vec::new(), Vec::new())
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

    /// Hash over the identities of its tables and maps, as the manifest of a bake of it holds.
    #[must_use]
    pub fn units_hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        let units = self.tables.iter().map(|t| &t.identity).chain(self.maps.iter().map(|m| &m.identity));
        for identity in units {
            hasher.update(identity.as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// The plan with further maps.
    ///
    /// # Errors
    /// [`PlanError`] with every fault of the maps.
    pub fn with_maps(mut self, maps: Vec<MapRequest>) -> Result<Plan, PlanError> {
        let mut faults = Faults::default();
        check_count([1, self.maps.len() + maps.len()], &mut faults);
        let mut taken: HashSet<String> = self.tables.iter().map(|t| t.name().to_ascii_lowercase()).collect();
        taken.extend(self.maps.iter().map(|m| m.name().to_ascii_lowercase()));
        for (i, draft) in maps.into_iter().map(MapDraft::from).enumerate() {
            let path = Path::map(i);
            name::check_map(&draft, &path, &mut taken, &mut faults);
            self.maps.extend(map::resolve(draft, &path, &mut faults).map(|m| m.identified(&self.name)));
        }
        self.hash = identity::of_plan(&self.name, &self.tables, &self.maps);
        if faults.is_empty() { Ok(self) } else { Err(PlanError { faults: faults.list }) }
    }

    /// One plan with the tables of several, in order.
    ///
    /// # Errors
    /// [`PlanError`] if there are no tables, too many, or two of the same name.
    pub fn join(name: &str, plans: Vec<Plan>) -> Result<Plan, PlanError> {
        let (mut tables, mut maps) = (Vec::new(), Vec::new());
        for plan in plans {
            tables.extend(plan.tables);
            maps.extend(plan.maps);
        }
        let mut faults = Faults::default();
        check_count([tables.len(), maps.len()], &mut faults);
        let mut taken = HashSet::new();
        for (i, map) in maps.iter().enumerate() {
            name::check_map(&MapDraft::from(map.asked.clone()), &Path::map(i), &mut taken, &mut faults);
        }
        for (i, table) in tables.iter().enumerate() {
            if !taken.insert(table.name().to_ascii_lowercase()) {
                let (got, why) = (table.name().to_owned(), "two plans have it".to_owned());
                let fault = Fault::Twice { what: "table name", got, why };
                faults.value(Path::table(i).key("name"), fault);
            }
        }
        if faults.is_empty() {
            Ok(Plan::new(name, tables, maps))
        } else {
            Err(PlanError { faults: faults.list })
        }
    }

    /// A plan of what is resolved and goes together; tables and maps get their identities as parts of it.
    fn new(name: &str, tables: Vec<PlannedTable>, maps: Vec<PlannedMap>) -> Plan {
        let tables: Vec<PlannedTable> = tables.into_iter().map(|t| t.identified(name)).collect();
        let maps: Vec<PlannedMap> = maps.into_iter().map(|m| m.identified(name)).collect();
        let hash = identity::of_plan(name, &tables, &maps);
        Plan { name: name.to_owned(), tables, maps, hash, reasons: None }
    }

    /// Name and tables under the keys of a recipe, with all defaults filled in; the same for requests that mean the same.
    #[must_use]
    pub fn canonical(&self) -> Json {
        let tables: Vec<Json> = self.tables.iter().map(PlannedTable::canonical).collect();
        let mut all = json!({ "name": self.name, "table": tables });
        if !self.maps.is_empty() {
            let map = |m: &PlannedMap| {
                let mut keys = m.asked.canonical();
                keys["name"] = m.name().into();
                keys
            };
            all["map"] = self.maps.iter().map(map).collect();
        }
        all
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
        names.extend(self.maps.iter().flat_map(PlannedMap::files));
        names.push(MANIFEST.to_owned());
        names
    }
}

/// A plan has tables or maps, and not too many of either.
pub(crate) fn check_count([tables, maps]: [usize; 2], faults: &mut Faults) {
    let allowed = format!("1 to {MAX_TABLES}");
    if (tables == 0 && maps == 0) || tables > MAX_TABLES {
        let allowed = allowed.clone();
        faults.key(Path::root().key("table"), Fault::Count { key: "table", got: tables, allowed });
    }
    if maps > MAX_TABLES {
        faults.key(Path::root().key("map"), Fault::Count { key: "map", got: maps, allowed });
    }
}

/// Resolves requests as they could be read. `tolerance` is that of tables without one. None if a part is missing; the faults say which.
pub(crate) fn resolve(
    name: Option<&str>,
    tolerance: Option<f64>,
    drafts: Vec<Draft>,
    maps: Vec<MapDraft>,
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
    let mut planned = Vec::new();
    for (i, draft) in maps.into_iter().enumerate() {
        let path = Path::map(i);
        name::check_map(&draft, &path, &mut taken, faults);
        planned.push(map::resolve(draft, &path, faults));
    }
    let tables: Vec<PlannedTable> = tables.into_iter().collect::<Option<_>>()?;
    let planned: Vec<PlannedMap> = planned.into_iter().collect::<Option<_>>()?;
    Some(Plan::new(name?, tables, planned))
}
