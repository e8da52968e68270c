// stores
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Ray {
    from_: vec3f,
    towards: vec3f,
}

struct Hit {
    ray: Ray,
    far: array<f32, 3>,
    frame: mat3x3f,
}

fn swizzles(v_in: vec4f, x: f32) -> vec4f {
    var v = v_in;
    v = vec4f(v.yx, v.zw);
    let v_zw = v.zw * 2.0;
    v = vec4f(v.xy, v_zw);
    v.b += x;
    let v_wx = v.wx - vec2f(x, 1.0);
    v = vec4f(v_wx.y, v.yz, v_wx.x);
    v = vec4f(v.zxy, v.w);
    v[2] = x;
    v[3] /= 2.0;
    return v;
}

fn columns(m_in: mat3x3f, v: vec3f, i: i32) -> mat3x3f {
    var m = m_in;
    m[0] = v;
    m[1] = vec3f(v.z, m[1].y, v.x);
    m[2][1] = 4.0;
    m[1][2] += v.y;
    m[i & 1] *= 0.5;
    return m;
}

fn elements(x: f32, i: i32) -> f32 {
    var points = array<vec2f, 3>(vec2f(x), vec2f(1.0, x), vec2f(0.0));
    points[1].y = 2.0;
    points[2] += points[0];
    points[i & 1].x -= 1.0;
    return points[0].x + points[1].x * points[1].y + points[2].x;
}

fn members(ray: Ray, x: f32) -> Hit {
    var hit: Hit;
    hit.ray = ray;
    let towards_xy = hit.ray.towards.xy * x;
    hit.ray.towards = vec3f(towards_xy, hit.ray.towards.z);
    hit.far = array<f32, 3>(x, 1.0, 2.0);
    hit.far[1] -= x;
    hit.frame = mat3x3f(x, 0.0, 0.0, 0.0, x, 0.0, 0.0, 0.0, x);
    hit.frame[1] = vec3f(ray.from_.y, hit.frame[1].y, ray.from_.x);
    hit.frame[2][0] = x;
    hit.ray.from_ = hit.frame * ray.from_;
    return hit;
}

fn of_a_hit(hit: Hit) -> f32 {
    return dot(hit.ray.from_, hit.ray.towards) + hit.far[0] * hit.far[1] + hit.frame[1].z;
}

fn whole_structs(v: vec3f, x: f32) -> f32 {
    let one = Ray(v, vec3f(x));
    var two = one;
    two.from_.y = x;
    let same = all(one.from_ == two.from_) && all(one.towards == two.towards);
    if (same) {
        return one.from_.y;
    }
    return two.from_.x + of_a_hit(members(two, x));
}

fn whole_numbers(n: ptr<function, vec3i>, bits: ptr<function, u32>) {
    let n_xy = (*n).xy % 7;
    *n = vec3i(n_xy, (*n).z);
    (*n).z <<= 1u;
    *bits |= 5u;
    *bits ^= u32((*n).x);
    *bits &= 255u;
    *bits >>= 1u;
}
