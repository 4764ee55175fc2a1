//! Exit codes, in one table.

use crate::cancel::Cancelled;
use crate::encode::EncodeError;
use crate::encode::atomic::WriteError;
use crate::pipeline::PipelineError;
use crate::pipeline::transaction::TransactionError;
use crate::recipe::{Diagnostic, RecipeError};
use crate::report::analytic::FitError;
use crate::tables::TexelError;
use crate::tables::driver::BakeError;
use serde_json::{Value as Json, json};

/// The table of exit codes, for `--help` and README.
pub const TABLE: &str = "Exit codes:
  0    done, or equal
  1    internal error
  2    usage
  3    bad recipe or input
  4    a law, a tolerance or a comparison failed
  5    input, output or resources (memory, threads, a locked folder) failed
  6    unsupported
  7    stale: the folder does not hold what would be baked (--check)
  130  interrupted";

/// How the program ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// Done, or equal.
    Done = 0,
    /// A fault of the program.
    Internal = 1,
    /// Bad arguments.
    Usage = 2,
    /// A bad recipe or input file.
    Input = 3,
    /// A law, a tolerance or a comparison failed.
    Failed = 4,
    /// Reading, writing, or getting memory or threads failed.
    Io = 5,
    /// Something that is not supported.
    Unsupported = 6,
    /// The folder does not hold what would be baked.
    Stale = 7,
    /// Interrupted by the user.
    Interrupted = 130,
}

impl Exit {
    /// What a container that does not take a table means: the recipe asks for what cannot be, as is told when it is read.
    #[must_use]
    pub fn of_encode(error: &EncodeError) -> Exit {
        if matches!(error, EncodeError::Library { .. }) { Exit::Internal } else { Exit::Input }
    }

    /// What a texel without a value means, in whatever verb: a delta or an integral without a rule is not supported;
    /// parameters without a value are those of the input.
    #[must_use]
    pub fn of_texel(error: &TexelError) -> Exit {
        match error {
            TexelError::NoWidth | TexelError::NoRule { .. } => Exit::Unsupported,
            _ => Exit::Input,
        }
    }
}

impl From<Exit> for std::process::ExitCode {
    fn from(exit: Exit) -> Self {
        std::process::ExitCode::from(exit as u8)
    }
}

/// A message and an exit code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// What to tell the user; may have several lines.
    pub message: String,
    /// The exit code.
    pub exit: Exit,
    /// The message in colours, where it has more of them than its first word.
    pub styled: Option<String>,
    /// What is wrong, one by one, as far as it is known: objects with `file`, `line`, `column`, `key`, `message` and so on.
    pub faults: Vec<Json>,
}

impl Failure {
    /// A failure with a message.
    pub fn new(exit: Exit, message: impl std::fmt::Display) -> Failure {
        Failure { message: message.to_string(), exit, styled: None, faults: Vec::new() }
    }

    /// The failure as JSON: an object for each fault, or one.
    #[must_use]
    pub fn objects(&self) -> Vec<Json> {
        let object = |fault: &Json| {
            let mut line = json!({ "reason": "error", "exit": self.exit as u8 });
            if let (Some(to), Some(from)) = (line.as_object_mut(), fault.as_object()) {
                to.extend(from.clone());
                to.entry("message").or_insert_with(|| self.message.clone().into());
            }
            line
        };
        if self.faults.is_empty() {
            return vec![object(&json!({ "message": self.message }))];
        }
        self.faults.iter().map(object).collect()
    }

    /// Says what the first fault is, too.
    #[must_use]
    pub fn at(mut self, key: &str, value: impl Into<Json>) -> Failure {
        if self.faults.is_empty() {
            self.faults.push(json!({}));
        }
        self.faults[0][key] = value.into();
        self
    }

    /// Bad arguments.
    pub fn usage(message: impl std::fmt::Display) -> Failure {
        Failure::new(Exit::Usage, message)
    }

    /// A bad input.
    pub fn input(message: impl std::fmt::Display) -> Failure {
        Failure::new(Exit::Input, message)
    }

    /// Reading or writing failed.
    pub fn io(what: impl std::fmt::Display, error: &std::io::Error) -> Failure {
        Failure::new(Exit::Io, format!("{what}: {error}")).at("file", what.to_string())
    }
}

impl From<Cancelled> for Failure {
    fn from(_: Cancelled) -> Failure {
        Failure::new(Exit::Interrupted, "interrupted")
    }
}

impl From<RecipeError> for Failure {
    fn from(error: RecipeError) -> Failure {
        let fault = |d: &Diagnostic| {
            let mut object = json!({ "file": error.file });
            if let (Some(to), Ok(Json::Object(from))) = (object.as_object_mut(), serde_json::to_value(d)) {
                to.extend(from);
            }
            object
        };
        let faults = error.diagnostics.iter().map(fault).collect();
        Failure { styled: Some(error.styled().to_owned()), faults, ..Failure::input(error) }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Failure {
        match error {
            WriteError::Cancelled => Failure::from(Cancelled),
            _ => Failure::new(Exit::Io, error),
        }
    }
}

impl From<FitError> for Failure {
    fn from(error: FitError) -> Failure {
        let exit = match &error {
            FitError::Cancelled(_) => Exit::Interrupted,
            FitError::Axis(error) => Exit::of_encode(error),
            FitError::Texel { error, .. } => Exit::of_texel(error),
            FitError::Table { .. } => Exit::Input,
            _ => Exit::Failed,
        };
        Failure::new(exit, error)
    }
}

impl From<PipelineError> for Failure {
    fn from(error: PipelineError) -> Failure {
        if let PipelineError::Map { map, error } = error {
            let failure = Failure::from(*error);
            return Failure { message: format!("map {map}: {}", failure.message), ..failure };
        }
        let exit = match &error {
            PipelineError::Bake { error: BakeError::Cancelled(_), .. }
            | PipelineError::Cancelled(_)
            | PipelineError::Files(TransactionError::Cancelled) => Exit::Interrupted,
            PipelineError::Bake { error: BakeError::Missed { .. }, .. }
            | PipelineError::Size { .. }
            | PipelineError::Laws(_)
            | PipelineError::Doubt(_)
            | PipelineError::Range { .. } => Exit::Failed,
            PipelineError::Bake { error: BakeError::Texel { error, .. }, .. } => Exit::of_texel(error),
            PipelineError::Files(TransactionError::Twice { .. }) => Exit::Input,
            PipelineError::Encode { error, .. } => Exit::of_encode(error),
            PipelineError::Fit { .. } | PipelineError::SizeGrid { .. } | PipelineError::Large(_) => {
                Exit::Input
            }
            PipelineError::Jobs { .. } => Exit::Usage,
            PipelineError::Files(_)
            | PipelineError::Memory { .. }
            | PipelineError::MapMemory { .. }
            | PipelineError::Threads { .. } => Exit::Io,
            _ => Exit::Internal,
        };
        if exit == Exit::Interrupted {
            return Failure::new(exit, "interrupted; nothing was written");
        }
        let mut message = error.to_string();
        if let PipelineError::Doubt(findings) = &error {
            for finding in findings {
                message.push_str(&format!("\n  {finding}"));
            }
        }
        if let PipelineError::Laws(findings) = &error {
            for finding in findings {
                message.push_str(&format!("\n  {finding}"));
            }
            message.push_str(
                "\n  To bake it all the same, add `waive = [{ law = \"...\", reason = \"...\" }]` to the table; the file will say so.",
            );
        }
        match &error {
            PipelineError::Files(TransactionError::Busy { .. }) => {
                message.push_str(" (--lock-timeout SECONDS waits longer)");
            }
            PipelineError::Memory { needed, .. } | PipelineError::MapMemory { needed, .. } => {
                let enough = needed.div_ceil(1_000_000_000);
                message.push_str(&format!(" (--memory {enough}GB)"));
            }
            _ => {}
        }
        Failure::new(exit, message)
    }
}
