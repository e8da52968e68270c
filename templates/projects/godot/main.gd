# {{ title }} on {{ mesh }}: drag turns the view, the wheel zooms, the arrow keys turn the lamp.
# In your own scene, all that matters is _ready: the body gets the shader{% if passes %}, and a node below it that draws what the shader reads{% endif %}.
extends Node3D

const CENTER := Vector3({{ center_xyz | join(", ") }})
const RADIUS := {{ radius }}

var _yaw := 0.34
var _pitch := 0.19
var _distance := 4.0
var _lamp_turn := -2.88

@onready var _camera: Camera3D = $Camera
@onready var _lamp: SpotLight3D = $Lamp


func _ready() -> void:
	var material := ShaderMaterial.new()
	material.shader = load("res://{{ name }}.gdshader")
	var body: Node = load("res://{{ body }}").instantiate()
	add_child(body)
	for mesh: MeshInstance3D in body.find_children("*", "MeshInstance3D", true, false):
		mesh.material_override = material
{% if passes %}
		mesh.add_child(load("res://{{ name }}_passes.gd").new())
{% endif %}
	_place()


func _process(delta: float) -> void:
	var turn := Input.get_axis("ui_left", "ui_right")
	if turn != 0.0:
		_lamp_turn += turn * delta
		_place()


func _unhandled_input(event: InputEvent) -> void:
	if event is InputEventMouseMotion and event.button_mask & MOUSE_BUTTON_MASK_LEFT:
		_yaw -= 0.008 * event.relative.x
		_pitch = clampf(_pitch + 0.008 * event.relative.y, -0.1, 1.4)
	elif event is InputEventMouseButton and event.pressed and event.button_index == MOUSE_BUTTON_WHEEL_UP:
		_distance = maxf(0.95 * _distance, 1.5)
	elif event is InputEventMouseButton and event.pressed and event.button_index == MOUSE_BUTTON_WHEEL_DOWN:
		_distance = minf(1.05 * _distance, 12.0)
	else:
		return
	_place()


func _place() -> void:
	var seen := Basis.from_euler(Vector3(-_pitch, _yaw, 0.0)) * Vector3(0.0, 0.0, _distance)
	_camera.look_at_from_position(CENTER + RADIUS * seen, CENTER)
	var lit := Vector3(sin(_lamp_turn), 0.45, cos(_lamp_turn))
	_lamp.look_at_from_position(CENTER + 3.5 * RADIUS * lit, CENTER)
