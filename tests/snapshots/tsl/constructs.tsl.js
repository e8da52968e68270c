// case
// Made by sssgen for TSL (three.js). Change the source and emit it again rather than this file.

import { Break, Continue, Fn, If, Loop, all, any, array, bool, dot, float, int, ivec2, ivec3, mat2, mat3,
    max, mod, round, select, sin, struct, uint, vec2, vec3, vec4 } from 'three/tsl';

export const Hit = /*@__PURE__*/ struct({ distance_: 'float', normal: 'vec3', id: 'int' }, 'Hit');

export const Scene = /*@__PURE__*/ struct({ nearest: 'Hit', frame: 'mat3' }, 'Scene');

export const TraceResult = /*@__PURE__*/ struct({ value: 'float', q: 'vec2', d: 'float' }, 'TraceResult');

export const SwapResult = /*@__PURE__*/ struct({ a: 'float', b: 'float' }, 'SwapResult');

export const BumpResult = /*@__PURE__*/ struct({ value: 'float', counter: 'float' }, 'BumpResult');

export const OrderResult = /*@__PURE__*/ struct({ value: 'float', counter: 'float' }, 'OrderResult');

const TAU = /*@__PURE__*/ float(6.2831853);
const WEIGHTS = /*@__PURE__*/ array([float(0.25), float(0.5), float(0.25)]);
const FRAME = /*@__PURE__*/ mat3(vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0), vec3(7.0, 8.0, 10.0));

export const matrixCompMult_ = /*@__PURE__*/ Fn(([x, y]) => {
    return mat2(x.element(0).mul(y.element(0)), x.element(1).mul(y.element(1)));
}).setLayout({ name: 'matrixCompMult_', type: 'mat2', inputs: [
    { name: 'x', type: 'mat2' },
    { name: 'y', type: 'mat2' },
] });

export const texture_ = /*@__PURE__*/ Fn(([map, P]) => {
    return map.sample(P.xy).depth(int(round(P.z)));
});

// The luminance of a linear colour.
export const luma = /*@__PURE__*/ Fn(([color]) => {
    const weights = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
    return dot(color, weights);
}).setLayout({ name: 'luma', type: 'float', inputs: [{ name: 'color', type: 'vec3' }] });

// Its parameter is assigned to, its result is negated bits.
export const hash = /*@__PURE__*/ Fn(([x_in]) => {
    const x = x_in.toVar();
    x.bitXorAssign(x.shiftRight(uint(16)));
    x.mulAssign(uint(0x7feb352d));
    return x.bitXor(x.shiftRight(uint(15))).bitNot();
}).setLayout({ name: 'hash', type: 'uint', inputs: [{ name: 'x_in', type: 'uint' }] });

export const guarded = /*@__PURE__*/ Fn(([x, n]) => {
    const result = float().toVar();
    const returned = bool(false).toVar();
    If(x.lessThan(0.0), () => {
        result.assign(-1.0);
    }).Else(() => {
        const sum = float(0.0).toVar();
        Loop({ start: 0, end: n, type: 'int', condition: '<', name: 'i' }, ({ i }) => {
            If(sum.greaterThan(10.0), () => {
                result.assign(sum);
                returned.assign(true);
                Break();
            });
            sum.addAssign(x.mul(float(i)));
            If(i.equal(int(3)), () => {
                Continue();
            });
            sum.mulAssign(1.5);
        });
        If(returned.not(), () => {
            result.assign(sum);
        });
    });
    return result;
}).setLayout({ name: 'guarded', type: 'float', inputs: [
    { name: 'x', type: 'float' },
    { name: 'n', type: 'int' },
] });

export const trace = /*@__PURE__*/ Fn(([p, d_in]) => {
    const q = vec2().toVar();
    const d = d_in.toVar();
    q.assign(p.yx.mul(2.0));
    d.addAssign(1.0);
    return TraceResult(d.mul(q.x), q, d);
}).setLayout({ name: 'trace', type: 'TraceResult', inputs: [
    { name: 'p', type: 'vec2' },
    { name: 'd_in', type: 'float' },
] });

export const traced = /*@__PURE__*/ Fn(([p]) => {
    const place = vec2(0.0).toVar();
    const d = float(0.5).toVar();
    const trace_result = trace(p, d).toConst();
    const value = trace_result.get('value').toConst();
    place.assign(trace_result.get('q'));
    d.assign(trace_result.get('d'));
    place.yx.addAssign(value);
    return select(place.x.greaterThan(0.0), d, mod(place.y, 2.0));
}).setLayout({ name: 'traced', type: 'float', inputs: [{ name: 'p', type: 'vec2' }] });

export const swap = /*@__PURE__*/ Fn(([a_in, b_in]) => {
    const a = a_in.toVar();
    const b = b_in.toVar();
    const kept = a.toConst();
    a.assign(b);
    b.assign(kept);
    return SwapResult(a, b);
}).setLayout({ name: 'swap', type: 'SwapResult', inputs: [
    { name: 'a_in', type: 'float' },
    { name: 'b_in', type: 'float' },
] });

export const median = /*@__PURE__*/ Fn(([v_in]) => {
    const v = v_in.toVar();
    If(v.x.greaterThan(v.y), () => {
        const a = v.x.toVar();
        const b = v.y.toVar();
        const swap_result = swap(a, b).toConst();
        a.assign(swap_result.get('a'));
        b.assign(swap_result.get('b'));
        v.x.assign(a);
        v.y.assign(b);
    });
    If(v.y.greaterThan(v.z), () => {
        const a_2 = v.y.toVar();
        const b_2 = v.z.toVar();
        const swap_result_2 = swap(a_2, b_2).toConst();
        a_2.assign(swap_result_2.get('a'));
        b_2.assign(swap_result_2.get('b'));
        v.y.assign(a_2);
        v.z.assign(b_2);
    });
    If(v.x.greaterThan(v.y), () => {
        const a_3 = v.x.toVar();
        const b_3 = v.y.toVar();
        const swap_result_3 = swap(a_3, b_3).toConst();
        a_3.assign(swap_result_3.get('a'));
        b_3.assign(swap_result_3.get('b'));
        v.x.assign(a_3);
        v.y.assign(b_3);
    });
    return v.y;
}).setLayout({ name: 'median', type: 'float', inputs: [{ name: 'v_in', type: 'vec3' }] });

export const bump = /*@__PURE__*/ Fn(([counter_in]) => {
    const counter = counter_in.toVar();
    counter.addAssign(1.5);
    return BumpResult(counter, counter);
}).setLayout({ name: 'bump', type: 'BumpResult', inputs: [{ name: 'counter_in', type: 'float' }] });

export const order = /*@__PURE__*/ Fn(([x, counter_in]) => {
    const counter = counter_in.toVar();
    counter.assign(x);
    const bump_result = bump(counter).toConst();
    const bump_value = bump_result.get('value').toConst();
    counter.assign(bump_result.get('counter'));
    const bump_result_2 = bump(counter).toConst();
    const bump_value_2 = bump_result_2.get('value').toConst();
    counter.assign(bump_result_2.get('counter'));
    const a = bump_value.add(bump_value_2.mul(2.0)).toConst();
    return OrderResult(a.add(counter), counter);
}).setLayout({ name: 'order', type: 'OrderResult', inputs: [
    { name: 'x', type: 'float' },
    { name: 'counter_in', type: 'float' },
] });

export const timed = /*@__PURE__*/ Fn(([x, u_time]) => {
    return sin(x.mul(TAU).add(u_time));
}).setLayout({ name: 'timed', type: 'float', inputs: [
    { name: 'x', type: 'float' },
    { name: 'u_time', type: 'float' },
] });

export const switched = /*@__PURE__*/ Fn(([k]) => {
    const result = int().toVar();
    const returned = bool(false).toVar();
    const r = int(0).toVar();
    If(k.equal(int(0)), () => {
        r.assign(int(1));
    }).ElseIf(k.equal(int(1)), () => {
        r.assign(int(5));
        r.addAssign(int(10));
    }).ElseIf(k.equal(int(2)), () => {
        r.addAssign(int(10));
    }).Else(() => {
        result.assign(int(-1));
        returned.assign(true);
    });
    If(returned.not(), () => {
        result.assign(r);
    });
    return result;
}).setLayout({ name: 'switched', type: 'int', inputs: [{ name: 'k', type: 'int' }] });

export const nested = /*@__PURE__*/ Fn(([n]) => {
    const result = float().toVar();
    const returned = bool(false).toVar();
    const sum = float(0.0).toVar();
    Loop({ start: 0, end: n, type: 'int', condition: '<', name: 'i' }, ({ i }) => {
        Loop({ start: i, end: -3, type: 'int', condition: '>', name: 'j', update: '-= 2' }, ({ j }) => {
            If(j.equal(int(1)), () => {
                Continue();
            });
            sum.addAssign(float(i.mul(j)));
            If(sum.greaterThan(40.0), () => {
                result.assign(sum.negate());
                returned.assign(true);
                Break();
            });
        });
        If(returned, () => {
            Break();
        });
    });
    If(returned.not(), () => {
        result.assign(sum);
    });
    return result;
}).setLayout({ name: 'nested', type: 'float', inputs: [{ name: 'n', type: 'int' }] });

export const grown = /*@__PURE__*/ Fn(([x_in]) => {
    const x = x_in.toVar();
    const rounds = int(0).toVar();
    Loop(true, () => {
        x.mulAssign(1.5);
        rounds.addAssign(int(1));
        If(x.greaterThan(50.0), () => {
            Break();
        });
        If(rounds.lessThan(int(6)).and(x.lessThan(20.0)).not(), () => {
            Break();
        });
    });
    const t = float(0.0).toVar();
    Loop(true, () => {
        If(t.lessThan(select(rounds.greaterThan(int(2)), 3.0, 1.5)).not(), () => {
            Break();
        });
        x.addAssign(t);
        t.addAssign(0.5);
    });
    const j = int(5).toVar();
    Loop({ start: 0, end: j, type: 'int', condition: '<', name: 'i' }, ({ i }) => {
        x.addAssign(float(i.mul(j)));
        j.subAssign(int(1));
    });
    return x;
}).setLayout({ name: 'grown', type: 'float', inputs: [{ name: 'x_in', type: 'float' }] });

export const closer = /*@__PURE__*/ Fn(([a, b]) => {
    const result = Hit(float(), vec3(), int()).toVar();
    If(a.get('distance_').lessThan(b.get('distance_')), () => {
        result.assign(a);
    }).Else(() => {
        result.assign(b);
    });
    return result;
}).setLayout({ name: 'closer', type: 'Hit', inputs: [
    { name: 'a', type: 'Hit' },
    { name: 'b', type: 'Hit' },
] });

export const seen = /*@__PURE__*/ Fn(([p]) => {
    const hits = array([Hit(float(), vec3(), int()), Hit(float(), vec3(), int())]).toVar();
    hits.element(0).assign(Hit(p.x, p, int(3)));
    hits.element(1).get('distance_').assign(p.y);
    hits.element(1).get('normal').assign(p.zyx);
    hits.element(1).get('id').assign(int(1));
    const hit = closer(hits.element(0), hits.element(1)).toVar();
    hit.get('normal').xy.addAssign(1.0);
    const scene = Scene(Hit(float(), vec3(), int()), mat3()).toVar();
    scene.get('nearest').assign(hit);
    scene.get('frame').assign(FRAME);
    scene.get('frame').element(1).x.assign(7.0);
    return scene.get('frame').mul(scene.get('nearest').get('normal')).x.add(float(hit.get('id')));
}).setLayout({ name: 'seen', type: 'float', inputs: [{ name: 'p', type: 'vec3' }] });

export const total = /*@__PURE__*/ Fn(([w, n]) => {
    const result = float().toVar();
    const returned = bool(false).toVar();
    const sum = float(0.0).toVar();
    Loop({ start: 0, end: 4, type: 'int', condition: '<', name: 'i' }, ({ i }) => {
        If(i.greaterThanEqual(n), () => {
            result.assign(sum);
            returned.assign(true);
            Break();
        });
        sum.addAssign(w.element(i).mul(WEIGHTS.element(i.bitAnd(int(1)))));
    });
    If(returned.not(), () => {
        result.assign(sum);
    });
    return result;
});

export const summed = /*@__PURE__*/ Fn(([v, k]) => {
    const w = array('float', 4).toVar();
    w.element(0).assign(v.x);
    w.element(1).assign(v.y);
    w.element(2).assign(v.z);
    w.element(3).assign(v.w);
    w.element(k.bitAnd(int(3))).mulAssign(2.0);
    return total(w, int(3));
}).setLayout({ name: 'summed', type: 'float', inputs: [
    { name: 'v', type: 'vec4' },
    { name: 'k', type: 'int' },
] });

export const compared = /*@__PURE__*/ Fn(([a, b]) => {
    const less = a.lessThan(vec3(0.5)).toConst();
    return all(a.equal(vec3(1.0))).or(any(b.notEqual(ivec2(0)))).or(less.x.notEqual(all(less.not())));
}).setLayout({ name: 'compared', type: 'bool', inputs: [
    { name: 'a', type: 'vec3' },
    { name: 'b', type: 'ivec2' },
] });

export const whole = /*@__PURE__*/ Fn(([a, b]) => {
    return a.div(max(b, int(1))).mod(int(7)).add(a.shiftLeft(uint(2))).sub(a.shiftRight(uint(1)))
        .add(b.bitNot()).add(int(uint(a).bitAnd(uint(255)))).add(int(uint(0xffffffff).shiftRight(uint(28))));
}).setLayout({ name: 'whole', type: 'int', inputs: [
    { name: 'a', type: 'int' },
    { name: 'b', type: 'int' },
] });

export const turned = /*@__PURE__*/ Fn(([m_in, s]) => {
    const m = m_in.toVar();
    m.element(0).divAssign(s);
    m.element(1).element(0).assign(2.0);
    const matrix = matrixCompMult_(m, mat2(vec2(2.0, 0.0), vec2(0.0, 2.0))).add(m.mul(float(1.0).div(2.0)))
        .toConst();
    return mat2(matrix.element(0).add(s), matrix.element(1).add(s));
}).setLayout({ name: 'turned', type: 'mat2', inputs: [
    { name: 'm_in', type: 'mat2' },
    { name: 's', type: 'float' },
] });

export const hidden = /*@__PURE__*/ Fn(([mix_, color]) => {
    const dot_ = mix_.mul(color).toVar();
    const mix_2 = dot_.add(1.0).toConst();
    dot_.addAssign(mix_2);
    return dot_;
}).setLayout({ name: 'hidden', type: 'float', inputs: [
    { name: 'mix_', type: 'float' },
    { name: 'color', type: 'float' },
] });

export const averaged = /*@__PURE__*/ Fn(([map, p]) => {
    const result = vec4().toVar();
    const returned = bool(false).toVar();
    If(p.x.lessThan(0.0), () => {
        result.assign(vec4(0.0));
    }).Else(() => {
        const sum = map.sample(p).toVar();
        Loop({ start: 0, end: 3, type: 'int', condition: '<', name: 'i' }, ({ i }) => {
            If(i.equal(int(2)).and(p.y.greaterThan(1.0)), () => {
                result.assign(sum);
                returned.assign(true);
                Break();
            });
            sum.addAssign(map.sample(p.add(float(i))).level(0.0));
        });
        If(returned.not(), () => {
            result.assign(sum.mul(vec2(ivec2(map.size(int(0)))).x));
        });
    });
    return result;
});

export const around = /*@__PURE__*/ Fn(([volume, sky, layers, p]) => {
    return volume.sample(p).add(sky.sample(p.add(0.1))).add(volume.load(ivec3(0, 1, 0)).level(int(0)))
        .add(texture_(layers, vec3(p.xy, 1.0)));
});
