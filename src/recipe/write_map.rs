//! Maps as the keys of a recipe that reads back to the same plan.

use crate::maps::Convention;
use crate::picture::{Space, Wrap};
use crate::plan::map::sbrdf::{BASE, BRDF, ColourInput, METALLIC, MODEL, NumberInput, Origin};
use crate::plan::map::{
    AnisotropyInput, FromLobe, Input, MapRequest, Packing, RoughnessInput, SbrdfRequest, Second, Source,
    words,
};
use serde_json::{Map, Value as Json, json};

type Keys = Map<String, Json>;

/// The keys of a map; none if one of its images lies in another file, or under a name that is no text.
pub(super) fn map(request: &MapRequest) -> Option<Keys> {
    let filter = &request.filter;
    let mut keys = Keys::new();
    let mut put = |key: &str, value: Json| keys.insert(key.to_owned(), value);
    put("name", json!(request.name));
    if let Some(input) = &request.normal {
        put("normal", normal(input)?);
    }
    put("roughness", roughness(&request.roughness)?);
    if let Some(AnisotropyInput { image, strength, rotation, wrap: _, resample }) = &request.anisotropy {
        let mut own = json!({ "strength": strength, "rotation": rotation, "resample": switch(*resample) });
        if let Some(image) = image {
            own["file"] = file(image)?;
        }
        put("anisotropy", own);
    }
    if let Some(lobes) = &request.sbrdf {
        put("sbrdf", sbrdf(lobes)?);
    }
    put("packing", json!(words::of(&Packing::ALL, &request.packing)));
    put("factor", json!(request.factor));
    put("rule", json!(filter.rule.id));
    put("normals", json!(words::of(&words::CENTRES, &filter.centre)));
    put("shape", json!(words::of(&words::SHAPES, &filter.shape)));
    put("effort", json!(words::of(&words::EFFORTS, &filter.effort)));
    put("objective", json!(words::of(&words::OBJECTIVES, &filter.objective)));
    put("outputs", request.outputs.iter().map(ToString::to_string).collect());
    put("check", json!(request.check));
    put("compare", switch(request.compare));
    Some(keys)
}

fn switch(on: bool) -> Json {
    json!(if on { "on" } else { "off" })
}

fn file(image: &Source) -> Option<Json> {
    match image {
        Source::File(path) => path.to_str().map(Json::from),
        Source::Memory { .. } => None,
    }
}

fn space(space: Space) -> Json {
    json!(words::of(&words::SPACES, &space))
}

fn normal(input: &Input) -> Option<Json> {
    let Convention { green_down, derive_z, scale, mend } = input.convention;
    let wrap = |w: &Wrap| words::of(&words::WRAPS, w);
    Some(json!({
        "file": file(&input.image)?,
        "channels": input.used(),
        "green": if green_down { "down" } else { "up" },
        "z": if derive_z { "derived" } else { "stored" },
        "scale": scale,
        "mend": switch(mend),
        "signed": switch(input.signed),
        "resample": switch(input.resample),
        "wrap": [wrap(&input.wrap[0]), wrap(&input.wrap[1])],
    }))
}

fn roughness(input: &RoughnessInput) -> Option<Json> {
    let RoughnessInput::Image { image, channel, space: coded, gloss, from } = input else {
        let RoughnessInput::Constant(r) = input else { return None };
        return Some(json!(r));
    };
    let mut out = json!({
        "file": file(image)?,
        "channel": channel,
        "space": space(*coded),
        "holds": if *gloss { "gloss" } else { "roughness" },
    });
    if let Some(from) = from {
        out["from"] = lobe(from);
    }
    Some(out)
}

fn lobe(from: &FromLobe) -> Json {
    let mut out = json!({
        "lobe": from.conversion.id,
        "range": from.range,
        "log": switch(from.log),
        "rule": words::of(&words::RULES, &from.by),
    });
    if let Some(Second { channel, angle }) = &from.second {
        out["second"] = json!(channel);
        if let Some(angle) = angle {
            out["angle"] = json!(angle);
        }
    }
    out
}

fn sbrdf(lobes: &SbrdfRequest) -> Option<Json> {
    let mut out = json!({
        "model": MODEL,
        "lobes": lobes.lobes,
        "normalise": words::of(&words::NORMALISE, &lobes.normalise),
    });
    if let Some(residual) = lobes.residual {
        out["residual"] = json!(residual);
    }
    match &lobes.origin {
        Origin::Tabulated(source) => out[BRDF] = file(source)?,
        Origin::Metallic { base, metallic } => {
            out[BASE] = match base {
                ColourInput::Constant(c) => json!(c),
                ColourInput::Image { image, space: coded } => {
                    json!({ "file": file(image)?, "space": space(*coded) })
                }
            };
            out[METALLIC] = match metallic {
                NumberInput::Constant(m) => json!(m),
                NumberInput::Image { image, channel } => json!({ "file": file(image)?, "channel": channel }),
            };
        }
    }
    Some(out)
}
