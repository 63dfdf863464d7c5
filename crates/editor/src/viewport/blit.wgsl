// Puts the picture of a view onto the window. Its colours are multiplied by their alpha.

@group(0) @binding(0) var picture: texture_2d<f32>;

struct Place {
    @builtin(position) clip: vec4<f32>,
    @location(0) at: vec2<f32>,
};

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Place {
    let corner = vec2<f32>(f32(index & 1u) * 2.0, f32(index >> 1u) * 2.0);
    var out: Place;
    out.clip = vec4<f32>(corner.x * 2.0 - 1.0, 1.0 - corner.y * 2.0, 0.0, 1.0);
    out.at = corner;
    return out;
}

fn texel(at: vec2<f32>) -> vec4<f32> {
    let size = vec2<f32>(textureDimensions(picture));
    let place = clamp(at * size, vec2<f32>(0.0), size - 1.0);
    return textureLoad(picture, vec2<i32>(place), 0);
}

@fragment
fn gamma(in: Place) -> @location(0) vec4<f32> {
    return texel(in.at);
}

// For a window whose format encodes by itself.
@fragment
fn linear(in: Place) -> @location(0) vec4<f32> {
    let colour = texel(in.at);
    let plain = colour.rgb / max(colour.a, 1e-4);
    return vec4<f32>(pow(plain, vec3<f32>(2.2)) * colour.a, colour.a);
}
