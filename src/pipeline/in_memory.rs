//! One table for a program: baked, checked, and held in memory to be read or encoded. Nothing is written.

use super::gather::Written;
use super::table::{self, Checked, Readings};
use super::{PipelineError, size};
use crate::cancel::{Cancel, untold};
use crate::grid::{Provenance, Table};
use crate::plan::{Output, Plan, PlanError, PlannedTable, TableRequest};
use crate::verify::Finding;

/// Why there is no table in memory.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InMemoryError {
    /// The request cannot be.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// A texel misses the tolerance, a law is broken, or the numbers do not fit the storage.
    #[error(transparent)]
    Bake(#[from] PipelineError),
}

/// A table in memory whose laws are kept.
#[derive(Debug)]
pub struct Baked {
    planned: PlannedTable,
    checked: Checked,
}

/// Bakes a table on all cores, and checks its laws.
///
/// ```
/// use brdfbake::grid::{Axis, Quantity, Texel};
/// use brdfbake::plan::{Output, TableRequest};
/// use brdfbake::tables::spec::Request;
///
/// let axis = |id, len| Quantity::find(id).map(|q| Axis::new(q, len, Texel::Center));
/// let request = Request {
///     kind: "albedo".into(),
///     model: Some("ggx".into()),
///     axes: Some([axis("mu", 8), axis("roughness", 8)].into_iter().flatten().collect()),
///     ..Request::default()
/// };
/// let asked = TableRequest { tolerance: Some(1e-6), ..TableRequest::new("ggx-e", request) };
/// let baked = brdfbake::bake(asked)?;
/// // texel 9: the second of the second row
/// assert!(baked.table().errors[9] <= 1e-6 && baked.table().values[9] < 1.0);
/// let file: Vec<u8> = baked.encode(&Output::parse("ktx2:half")?)?;
/// # assert!(file.starts_with(b"\xabKTX 20"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`InMemoryError::Plan`] with every fault of the request, [`InMemoryError::Bake`] with the texels or laws at fault.
pub fn bake(asked: TableRequest) -> Result<Baked, InMemoryError> {
    bake_until(&Cancel::new(), asked)
}

/// [`bake`], until it is stopped.
///
/// # Errors
/// Those of [`bake`]; [`PipelineError::Cancelled`] among them.
pub fn bake_until(cancel: &Cancel, asked: TableRequest) -> Result<Baked, InMemoryError> {
    let name = asked.name.clone();
    let plan = Plan::from_requests(&name, vec![asked])?;
    let Some(mut planned) = plan.tables.into_iter().next() else {
        return Err(PlanError { faults: Vec::new() }.into());
    };
    if let Some(sizing) = &planned.asked.size {
        planned = size::resolve(&planned, sizing, cancel)?;
    }
    let table = table::bake(&planned, cancel, &|_| {})?;
    let checked = table::check(&name, &planned, table, cancel, &untold)?;
    Ok(Baked { planned, checked })
}

impl Baked {
    /// Axes, channels, values, and the estimated error of each value.
    #[must_use]
    pub fn table(&self) -> &Table {
        self.checked.verified.table()
    }

    /// What a file of it says of itself: formula, sources, conventions, laws, errors.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.checked.provenance
    }

    /// What was found that is no breach: laws that could not be checked, texels that miss the tolerance where that is allowed.
    #[must_use]
    pub fn findings(&self) -> &[Finding] {
        &self.checked.warnings
    }

    /// The numbers that a file holds, `[texel][channel]`: rounded, and fitted where the request says so.
    ///
    /// # Errors
    /// As [`Baked::encode`].
    pub fn stored(&self, output: &Output) -> Result<Vec<f64>, PipelineError> {
        let mut stored = None;
        self.written(output, Some(&mut stored))?;
        Ok(stored.unwrap_or_default())
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// [`PipelineError::Range`] where the storage cannot hold a value, [`PipelineError::Encode`] where the container cannot hold
    /// the table.
    pub fn encode(&self, output: &Output) -> Result<Vec<u8>, PipelineError> {
        match self.written(output, None)? {
            Written::File(bytes) => Ok(bytes),
            // a part of a file that others share: this table is alone
            Written::Part(_) => Err(PipelineError::Metadata {
                table: self.planned.name().to_owned(),
                message: "a table in memory has no file to share".to_owned(),
            }),
        }
    }

    fn written(
        &self,
        output: &Output,
        kept: Option<&mut Option<Vec<f64>>>,
    ) -> Result<Written, PipelineError> {
        let cancel = Cancel::new();
        let Checked { verified, provenance, .. } = &self.checked;
        let readings = Readings::new(&self.planned, verified.table(), &cancel)?;
        let source = readings.source(&self.planned, verified.table(), &cancel);
        let file = self.planned.name();
        let made = table::encode_output(&self.planned, output, &source, provenance, file, false, kept)?;
        Ok(made.1)
    }
}
