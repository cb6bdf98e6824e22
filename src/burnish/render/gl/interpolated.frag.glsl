// Shows the values of vertices.
in vec3 burnish_value;
out vec4 burnish_color;

void main() {
  burnish_color = vec4(burnish_value, 1.0);
}
