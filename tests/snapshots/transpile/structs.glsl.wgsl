// structs
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Wave {
    height: f32,
    length_: f32,
    towards: vec2f,
}

struct Foam {
    color: vec3f,
    amount: f32,
}

struct Sea {
    waves: array<Wave, 2>,
    foam: Foam,
    frame: mat2x2f,
}

struct Unnamed {
    gain: f32,
    offset: vec2f,
}

struct Level {
    count: i32,
    bias: f32,
}

struct Local {
    kept: f32,
}

const LEVEL: Level = Level(2, 0.25);

var<private> first: Wave = Wave(1.0, 2.0, vec2f(1.0, 0.0));
var<private> second: Wave;
var<private> settings: Unnamed;

fn surface(sea: Sea, p: vec2f) -> f32 {
    var sum = LEVEL.bias;
    for (var i = 0; i < LEVEL.count; i++) {
        let wave = sea.waves[i];
        sum += wave.height * sin(dot(sea.frame * p, wave.towards) / (abs(wave.length_) + 1.0));
    }
    return sum + sea.foam.amount * sea.foam.color.g;
}

fn calm(x: f32) -> Sea {
    let local = Local(x);
    second = first;
    second.towards.y = local.kept;
    settings.gain = 0.5;
    settings.offset = vec2f(x);
    var sea: Sea;
    sea.waves[0] = first;
    sea.waves[1] = second;
    sea.waves[1].height *= settings.gain;
    sea.foam.color = vec3f(x);
    sea.foam.amount = settings.offset.x;
    sea.frame = mat2x2f(1.0, x, -x, 1.0);
    return sea;
}

fn of_both(p: vec2f, x: f32) -> f32 {
    let calm_value = calm(x);
    let calm_value_2 = calm(p.y);
    return surface(calm_value, p) + surface(calm_value_2, vec2f(x));
}
