//! `--texel FILE:X,Y,LEVEL`: a texel of a map as parameters of `eval` and `plot`.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::ReadError;
use crate::pipeline::map::texel::{MapTexel, TexelError, TexelPlace};

/// Options of a texel.
#[derive(Debug, clap::Args)]
pub(super) struct Texels {
    /// A texel of a map that `brdfbake map` wrote tells the widths, the normal and direction, or the lobes: a file, or the beginning of
    /// the names of all files of a map (maps/bark). May be given several times, for files that lie over each other.
    #[arg(long = "texel", value_name = "FILE:X,Y[,LEVEL]")]
    texels: Vec<String>,
    /// Which colour of its albedos.
    #[arg(long, value_enum, default_value = "green", requires = "texels")]
    texel_colour: Colour,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Colour {
    Red,
    Green,
    Blue,
}

impl Texels {
    /// What the texel tells, if one is named.
    pub(super) fn read(&self, cancel: &Cancel) -> Result<Option<MapTexel>, Failure> {
        if self.texels.is_empty() {
            return Ok(None);
        }
        let places: Result<Vec<TexelPlace>, _> = self.texels.iter().map(|t| TexelPlace::parse(t)).collect();
        let texel = MapTexel::read(&places.map_err(failure)?, self.texel_colour as usize, cancel);
        let texel = texel.map_err(failure)?;
        output::talk(&format!("texel: {}", texel.words()));
        if texel.coloured() {
            let colour = format!("{:?}", self.texel_colour).to_lowercase();
            output::talk(&format!("its albedos differ between colours; {colour} is taken (--texel-colour)"));
        }
        Ok(Some(texel))
    }
}

fn failure(error: TexelError) -> Failure {
    let exit = match &error {
        TexelError::Form(_) => Exit::Usage,
        TexelError::Read { source: ReadError::Io { .. }, .. } => Exit::Io,
        TexelError::Read { source: ReadError::Cancelled(_), .. } => Exit::Interrupted,
        _ => Exit::Input,
    };
    Failure::new(exit, format!("--texel {error}"))
}
