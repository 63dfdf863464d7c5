// What a view draws: surfaces by how they are to be looked at, and lines of a width in pixels.

struct View {
    view_projection: mat4x4<f32>,
    right: vec4<f32>,
    up: vec4<f32>,
    back: vec4<f32>,
    eye: vec4<f32>,
    // Pixels of the view; how surfaces are shaded; 1 without perspective.
    size_shading: vec4<f32>,
};
struct Draw {
    // sRGB with alpha.
    colour: vec4<f32>,
    // Width of lines in pixels; how far they come forward; scale of the curvature; how strongly it is marked.
    numbers: vec4<f32>,
};
@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> draw: Draw;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) place: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) curvature: f32,
};

@vertex
fn surface_vertex(@location(0) place: vec3<f32>, @location(1) normal: vec3<f32>, @location(2) curvature: f32) -> Corner {
    var out: Corner;
    out.clip = view.view_projection * vec4<f32>(place, 1.0);
    out.clip.z -= draw.numbers.y * select(1.0, 0.004, view.size_shading.w > 0.5) * out.clip.w;
    out.place = place;
    out.normal = normal;
    out.curvature = curvature;
    return out;
}

fn linear(colour: vec3<f32>) -> vec3<f32> {
    return pow(colour, vec3<f32>(2.2));
}

fn encoded(colour: vec3<f32>) -> vec3<f32> {
    return pow(clamp(colour, vec3<f32>(0.0), vec3<f32>(1.0)), vec3<f32>(1.0 / 2.2));
}

@fragment
fn surface_fragment(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    var n = normalize(in.normal);
    var towards = view.back.xyz;
    if (view.size_shading.w < 0.5) {
        towards = normalize(view.eye.xyz - in.place);
    }
    let side = select(-1.0, 1.0, front);
    n = n * side;
    let seen = vec3<f32>(dot(n, view.right.xyz), dot(n, view.up.xyz), dot(n, view.back.xyz));
    let mode = i32(view.size_shading.z + 0.5);
    var colour: vec3<f32>;
    if (mode == 1) {
        // A ball of clay under a window, as a function of the normal on the screen.
        let key = clamp(dot(seen, normalize(vec3<f32>(-0.45, 0.65, 0.62))), 0.0, 1.0);
        let sky = 0.5 + 0.5 * seen.y;
        let edge = pow(1.0 - clamp(seen.z, 0.0, 1.0), 3.0);
        colour = vec3<f32>(0.09, 0.075, 0.075) + vec3<f32>(0.62, 0.47, 0.39) * key * key + vec3<f32>(0.14, 0.16, 0.2) * sky;
        colour += vec3<f32>(0.85, 0.8, 0.75) * pow(key, 28.0) * 0.35 + vec3<f32>(0.2, 0.24, 0.3) * edge;
        colour = encoded(colour);
    } else if (mode == 2) {
        colour = select(vec3<f32>(0.86, 0.13, 0.12) * (0.55 + 0.45 * seen.z), 0.5 + 0.5 * n, front);
    } else if (mode == 3) {
        // Stripes of light all around: where they break, the surface is not smooth.
        let bounced = reflect(-towards, n);
        let turn = acos(clamp(dot(bounced, view.up.xyz), -1.0, 1.0)) * 6.5;
        let soft = max(fwidth(turn), 1e-4);
        let wave = abs(fract(turn) - 0.5) - 0.25;
        let light = clamp(wave / soft + 0.5, 0.0, 1.0);
        colour = mix(vec3<f32>(0.07, 0.08, 0.1), vec3<f32>(0.94, 0.95, 0.93), light) * (0.72 + 0.28 * seen.z);
    } else if (mode == 4) {
        let bent = clamp(in.curvature / draw.numbers.z, -1.0, 1.0);
        let flat = vec3<f32>(0.9, 0.9, 0.88);
        let bulge = vec3<f32>(0.80, 0.19, 0.12);
        let hollow = vec3<f32>(0.13, 0.36, 0.72);
        colour = mix(flat, select(hollow, bulge, bent > 0.0), sqrt(abs(bent))) * (0.62 + 0.38 * seen.z);
    } else if (mode == 5) {
        // Pale, so that the outline and its colours stand out.
        colour = vec3<f32>(0.44, 0.46, 0.5) * (0.55 + 0.45 * seen.z);
    } else if (mode == 6) {
        let across = cross(dpdx(in.place), dpdy(in.place));
        var face = across / max(length(across), 1e-20);
        face = face * sign(dot(face, towards));
        let key = clamp(dot(vec3<f32>(dot(face, view.right.xyz), dot(face, view.up.xyz), dot(face, view.back.xyz)), normalize(vec3<f32>(-0.4, 0.6, 0.7))), 0.0, 1.0);
        colour = encoded(linear(draw.colour.rgb) * (0.18 + 0.85 * key));
    } else {
        let base = linear(draw.colour.rgb) * select(vec3<f32>(0.62, 0.58, 0.66), vec3<f32>(1.0), front);
        let key = clamp(dot(seen, normalize(vec3<f32>(-0.4, 0.6, 0.7))), 0.0, 1.0);
        let fill = clamp(dot(seen, normalize(vec3<f32>(0.8, -0.1, 0.55))), 0.0, 1.0);
        let sky = 0.5 + 0.5 * n.y;
        let half_way = normalize(seen * 0.0 + normalize(vec3<f32>(-0.4, 0.6, 0.7)) + vec3<f32>(0.0, 0.0, 1.0));
        let shine = pow(clamp(dot(seen, half_way), 0.0, 1.0), 36.0) * 0.09;
        colour = encoded(base * (0.16 + 0.14 * sky + 0.78 * key + 0.22 * fill) + shine);
    }
    colour = mix(colour, vec3<f32>(1.0, 0.62, 0.18), draw.numbers.w);
    return vec4<f32>(colour, 1.0);
}

struct LinePoint {
    @builtin(position) clip: vec4<f32>,
    // Pixels from the middle of the line.
    @location(0) beside: f32,
};

@vertex
fn line_vertex(@builtin(vertex_index) index: u32, @location(0) begin: vec3<f32>, @location(1) end: vec3<f32>) -> LinePoint {
    var a = view.view_projection * vec4<f32>(begin, 1.0);
    var b = view.view_projection * vec4<f32>(end, 1.0);
    // What is behind the eye is cut off before it is divided by w.
    let near = 1e-4;
    if (a.w < near && b.w >= near) { a = mix(b, a, (b.w - near) / (b.w - a.w)); }
    if (b.w < near && a.w >= near) { b = mix(a, b, (a.w - near) / (a.w - b.w)); }
    let size = view.size_shading.xy;
    let pa = a.xy / a.w * size * 0.5;
    let pb = b.xy / b.w * size * 0.5;
    var along = pb - pa;
    let length_of = length(along);
    along = select(vec2<f32>(1.0, 0.0), along / max(length_of, 1e-6), length_of > 1e-6);
    let across = vec2<f32>(-along.y, along.x);
    let half_width = draw.numbers.x * 0.5 + 0.5;
    var corners = array<vec2<f32>, 6>(vec2<f32>(0.0, -1.0), vec2<f32>(1.0, -1.0), vec2<f32>(1.0, 1.0),
                                      vec2<f32>(0.0, -1.0), vec2<f32>(1.0, 1.0), vec2<f32>(0.0, 1.0));
    let corner = corners[index];
    var clip = mix(a, b, corner.x);
    // Joints are covered by making each piece a little longer.
    let reach = along * (corner.x * 2.0 - 1.0) * draw.numbers.x * 0.35 + across * corner.y * half_width;
    // Without perspective, depth is spread over a thousand times the distance of the eye.
    let forward = draw.numbers.y * select(1.0, 0.004, view.size_shading.w > 0.5);
    clip = vec4<f32>(clip.xy + reach / (size * 0.5) * clip.w, clip.z - forward * clip.w, clip.w);
    var out: LinePoint;
    out.clip = clip;
    if (a.w < near && b.w < near) { out.clip = vec4<f32>(0.0, 0.0, -2.0, 1.0); }
    out.beside = corner.y * half_width;
    return out;
}

@fragment
fn line_fragment(in: LinePoint) -> @location(0) vec4<f32> {
    let cover = clamp(draw.numbers.x * 0.5 + 0.5 - abs(in.beside), 0.0, 1.0);
    return vec4<f32>(draw.colour.rgb, draw.colour.a * cover);
}
