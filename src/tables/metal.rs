//! Which metal a table is of: measured, rows of a file, or an index that is given, for all wavelengths or for red, green and blue.

use crate::models::{Column, DefaultValue, Param, ParamError, Params};
use crate::terms::metals;

/// What a row of `nk` holds. A recipe may name a file in the place of rows of these columns.
pub const NK_COLUMNS: &[Column] = &[
    Column { id: "lambda_nm", min: 1.0, max: 1e6 },
    Column { id: "n", min: 0.0, max: 1e3 },
    Column { id: "k", min: 0.0, max: 1e3 },
];

/// `nk`.
pub(super) const NK: Param = Param::rows(
    "nk",
    "of metal rows: wavelength, n, k; or the name of a file of refractiveindex.info, CSV or YAML",
    NK_COLUMNS,
    &[],
);

/// `eta`.
pub(super) const ETA: Param = Param::number(
    "eta",
    "eta",
    "index of what lies above, 1 for vacuum, 1.5 for a coat of varnish: all other indices are divided by it",
    [0.1, 10.0],
    DefaultValue::Value(1.0),
);

/// Where the index of a metal is from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Index<'a> {
    /// One of [`metals::METALS`].
    Measured(&'static [[f64; 3]]),
    /// Rows of the recipe.
    Rows(&'a [Vec<f64>]),
    /// The same at all wavelengths, or a number for each of red, green and blue.
    Given {
        /// Real parts.
        n: [f64; 3],
        /// Extinction coefficients.
        k: [f64; 3],
    },
}

impl<'a> Index<'a> {
    /// As `metal`, `nk` and the numbers of these two names say.
    ///
    /// # Errors
    /// [`ParamError::Together`] for rows that are not there, not in order, or given in vain.
    pub fn of(params: &'a Params, [n, k]: [&str; 2]) -> Result<Index<'a>, ParamError> {
        let rows = params.rows("nk")?;
        let metal = params.choice("metal")?;
        let wrong = |why: String| ParamError::Together { model: params.model(), why };
        if metal == "rows" {
            let order = rows.windows(2).position(|pair| pair[0][0] >= pair[1][0]);
            return match order {
                _ if rows.len() < 2 => {
                    Err(wrong("metal = \"rows\" wants two rows or more: nk = [[lambda_nm, n, k], ...], or nk = \"FILE\"".to_owned()))
                }
                Some(i) => Err(wrong(format!("nk: row {} is not beyond the wavelength of row {}", i + 2, i + 1))),
                None => Ok(Index::Rows(rows)),
            };
        }
        if !rows.is_empty() {
            return Err(wrong(format!(
                "nk is given, but metal = \"{metal}\" does not read it: write metal = \"rows\""
            )));
        }
        Ok(match metals::find(metal) {
            Some(metal) => Index::Measured(metal.rows),
            None => Index::Given { n: params.rgb(n)?, k: params.rgb(k)? },
        })
    }

    /// Checks that it is known over a spectrum: rows from 400 to 700 nm or beyond, or one number for all wavelengths.
    ///
    /// # Errors
    /// [`ParamError::Together`].
    pub fn spectral(&self, model: &'static str) -> Result<(), ParamError> {
        let wrong = |why: &str| Err(ParamError::Together { model, why: why.to_owned() });
        let one = |v: &[f64; 3]| v.iter().all(|x| (x - v[0]).abs() == 0.0);
        match self {
            Index::Given { n, k } if !(one(n) && one(k)) => wrong(
                "lists of three have no spectrum to integrate: take a layout of red, green and blue apart, or rows",
            ),
            Index::Rows(_) => self.covers(model, [400.0, 700.0]),
            _ => Ok(()),
        }
    }

    /// Checks that rows reach from one wavelength to another.
    ///
    /// # Errors
    /// [`ParamError::Together`].
    pub fn covers(&self, model: &'static str, [low, high]: [f64; 2]) -> Result<(), ParamError> {
        let ends = match self {
            Index::Rows(rows) => rows.first().zip(rows.last()).map(|(a, b)| (a[0], b[0])),
            _ => None,
        };
        match ends {
            Some((first, last)) if first > low || last < high => {
                let why = format!("nk reaches from {first} to {last} nm, but {low} to {high} nm are wanted");
                Err(ParamError::Together { model, why })
            }
            _ => Ok(()),
        }
    }

    /// n and k at a wavelength, or of a colour: 0 red, 1 green, 2 blue.
    #[must_use]
    pub fn at(&self, colour: usize, lambda_nm: f64) -> (f64, f64) {
        match self {
            Index::Measured(rows) => metals::index(rows, lambda_nm),
            Index::Rows(rows) => metals::index(rows, lambda_nm),
            Index::Given { n, k } => (n[colour], k[colour]),
        }
    }

    /// Wavelengths of its rows, nm: kinks of the reflectance.
    #[must_use]
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Index::Measured(rows) => rows.iter().map(|r| r[0]).collect(),
            Index::Rows(rows) => rows.iter().map(|r| r[0]).collect(),
            Index::Given { .. } => Vec::new(),
        }
    }
}
