// prefix_sum
// Made by sssgen for WGSL (WebGPU). Change the source and emit it again rather than this file.

struct Input {
    values: array<f32>,
}

struct Output {
    sums: array<f32>,
}

struct Totals {
    totals: array<f32>,
}

@group(1) @binding(1) var<storage, read> input: Input;
@group(1) @binding(2) var<storage, read_write> output: Output;
@group(1) @binding(3) var<storage, read_write> totals_buffer: Totals;
var<workgroup> partial: array<array<f32, 64>, 2>;
var<private> GlobalInvocationID: vec3u;
var<private> LocalInvocationID: vec3u;
var<private> WorkGroupID: vec3u;

fn main_() {
    let i = GlobalInvocationID.x;
    let lane = LocalInvocationID.x;
    var from_ = 0;
    var count: i32;
    count = i32(arrayLength(&input.values));
    partial[from_][lane] = select(0.0, input.values[i], i < u32(count));
    workgroupBarrier();
    for (var offset = 1u; offset < 64u; offset *= 2u) {
        let to = 1 - from_;
        var sum = partial[from_][lane];
        if (lane >= offset) {
            sum += partial[from_][lane - offset];
        }
        partial[to][lane] = sum;
        workgroupBarrier();
        from_ = to;
    }
    var count_2: i32;
    count_2 = i32(arrayLength(&output.sums));
    if (i < u32(count_2)) {
        output.sums[i] = partial[from_][lane];
    }
    if (lane == 64u - 1u) {
        totals_buffer.totals[WorkGroupID.x] = partial[from_][lane];
    }
}

@compute @workgroup_size(64, 1, 1)
fn compute_main(@builtin(global_invocation_id) GlobalInvocationID_in: vec3u,
    @builtin(local_invocation_id) LocalInvocationID_in: vec3u, @builtin(workgroup_id) WorkGroupID_in: vec3u) {
    GlobalInvocationID = GlobalInvocationID_in;
    LocalInvocationID = LocalInvocationID_in;
    WorkGroupID = WorkGroupID_in;
    main_();
}
