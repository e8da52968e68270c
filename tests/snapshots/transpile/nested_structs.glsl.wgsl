// nested_structs
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Corner {
    weight: f32,
    place: vec2f,
}

fn corner(x: f32, i: i32) -> vec2f {
    var corners: array<array<Corner, 2>, 2>;
    corners[0] = array<Corner, 2>(Corner(x, vec2f(1.0)), Corner(2.0, vec2f(x)));
    corners[1][0] = Corner(3.0, vec2f(x, 1.0));
    corners[1][1] = corners[0][1];
    corners[1][i & 1].weight += 1.0;
    let last = corners[1];
    let compared = corners[0];
    let compared_2 = corners[0];
    let compared_3 = compared[0];
    let compared_4 = compared_2[0];
    let compared_5 = compared[1];
    let compared_6 = compared_2[1];
    let compared_7 = corners[1];
    let compared_8 = corners[1];
    let compared_9 = compared_7[0];
    let compared_10 = compared_8[0];
    let compared_11 = compared_7[1];
    let compared_12 = compared_8[1];
    return corners[i & 1][0].place * last[1].weight
        + vec2f(corners[1][1].weight,
        f32(compared_3.weight == compared_4.weight && all(compared_3.place == compared_4.place)
        && (compared_5.weight == compared_6.weight && all(compared_5.place == compared_6.place))
        && (compared_9.weight == compared_10.weight && all(compared_9.place == compared_10.place)
        && (compared_11.weight == compared_12.weight && all(compared_11.place == compared_12.place)))));
}

fn sums(i: i32, j: i32) -> f32 {
    let fixed_rows = array<array<f32, 2>, 3>(array<f32, 2>(1.0, 2.0), array<f32, 2>(3.0, 4.0),
        array<f32, 2>(5.0, 6.0));
    let free_rows = array<array<f32, 2>, 2>(array<f32, 2>(1.0, 2.0), array<f32, 2>(3.0, 4.0));
    let listed = array<array<f32, 3>, 2>(array<f32, 3>(1.0, 2.0, 3.0), array<f32, 3>(4.0, 5.0, 6.0));
    return fixed_rows[i & 1][j & 1] + free_rows[i & 1][j & 1] + listed[i & 1][j & 1];
}

fn rounds(n: i32) -> i32 {
    var sum = 0;
    for (var i = 0; ; ) {
        let goes_on = i < n && i < 8;
        if (!goes_on) {
            break;
        }
        if (i == 3) {
            i++;
            continue;
        }
        sum += select(100, i, goes_on);
        i++;
    }
    while (true) {
        let more = sum > 20;
        if (!more) {
            break;
        }
        sum -= select(0, 7, more);
    }
    return sum;
}
