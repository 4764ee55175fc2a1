//! Roughness whose alpha² a shader's numbers do not resolve.

use super::{Breaks, Rule};

pub(super) static HALF: Rule = Rule {
    id: "smooth-half",
    title: "roughness is no less than shaders with half floats take (alpha^2 = 6.3e-5)",
    measure: |texel, _| Some(texel.roughness),
    breaks: Breaks::Below,
    bound: 0.089,
    share: 0.0,
};

pub(super) static FLOAT: Rule = Rule {
    id: "smooth-float",
    title: "roughness is no less than shaders with floats take (alpha^2 = 4.1e-6)",
    measure: |texel, _| Some(texel.roughness),
    breaks: Breaks::Below,
    bound: 0.045,
    share: 0.0,
};
