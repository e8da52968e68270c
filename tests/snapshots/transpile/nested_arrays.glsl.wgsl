// nested_arrays
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Grid {
    cells: array<array<i32, 3>, 2>,
    weight: f32,
}

const KERNEL: array<array<f32, 3>, 3> = array<array<f32, 3>, 3>(array<f32, 3>(1.0, 2.0, 1.0),
    array<f32, 3>(2.0, 4.0, 2.0), array<f32, 3>(1.0, 2.0, 1.0));
const CORNERS: array<array<vec2f, 2>, 2> = array<array<vec2f, 2>, 2>(array<vec2f, 2>(vec2f(0.0),
    vec2f(1.0, 0.0)), array<vec2f, 2>(vec2f(0.0, 1.0), vec2f(1.0)));

fn total(values: array<array<f32, 2>, 3>) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 3; i++) {
        for (var j = 0; j < 2; j++) {
            sum += values[i][j];
        }
    }
    return sum;
}

fn doubled(values_in: array<array<f32, 3>, 2>, gain: f32) -> array<array<f32, 3>, 2> {
    var values = values_in;
    values[0][1] *= 2.0;
    values[1] = array<f32, 3>(values[1][2], values[1][0], gain);
    return values;
}

fn of_table(i: i32, j: i32, table: array<f32, 6>) -> f32 {
    let row = array<f32, 2>(table[i * 2], table[i * 2 + 1]);
    return row[j] + table[5]
        * total(array<array<f32, 2>, 3>(array<f32, 2>(table[0], table[1]), array<f32, 2>(table[2], table[3]),
        array<f32, 2>(table[4], table[5])));
}

fn filtered(x: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 3; i++) {
        for (var j = 0; j < 3; j++) {
            sum += KERNEL[i][j] * sin(x + f32(i - j));
        }
    }
    return sum / 16.0;
}

fn corner(i: i32, j: i32) -> vec2f {
    return CORNERS[i][j] * 2.0 - CORNERS[1][1];
}

fn mixed_color(i: i32, x: f32, colors: array<vec3f, 4>) -> vec3f {
    return mix(colors[i * 2], colors[i * 2 + 1], x);
}

fn fill(cells: ptr<function, array<array<i32, 3>, 2>>, start: i32) {
    for (var i = 0; i < 6; i++) {
        (*cells)[i / 3][i % 3] = start + i;
    }
}

fn cell(i: i32, j: i32) -> i32 {
    var grid: Grid;
    var cells: array<array<i32, 3>, 2>;
    fill(&cells, 5);
    grid.cells = cells;
    var other = grid;
    other.cells[1] = grid.cells[0];
    other.weight = 1.0;
    return other.cells[i][j] + grid.cells[1][2];
}

fn stepped(x: f32, gain: f32) -> f32 {
    let pairs = array<array<f32, 2>, 3>(array<f32, 2>(x, 1.0), array<f32, 2>(2.0, x),
        array<f32, 2>(x * x, 3.0));
    let changed = doubled(array<array<f32, 3>, 2>(array<f32, 3>(x, x, x), array<f32, 3>(1.0, 2.0, 3.0)),
        gain);
    return total(pairs) + changed[0][1] + changed[1][1];
}

fn alike(a: array<array<f32, 2>, 2>, b: array<array<f32, 2>, 2>) -> bool {
    let compared = a[0];
    let compared_2 = b[0];
    let compared_3 = a[1];
    let compared_4 = b[1];
    return compared[0] == compared_2[0] && compared[1] == compared_2[1]
        && (compared_3[0] == compared_4[0] && compared_3[1] == compared_4[1]);
}
