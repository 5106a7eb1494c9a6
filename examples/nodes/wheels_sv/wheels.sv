// A robot with two wheels, 0.5 m apart: Twist comes in, the speeds of both wheels go out.
// Ports are those that `firm-hdl node info wheels.yaml --members` lists.
module wheels (
  input  logic        aclk,
  input  logic        aresetn,

  input  logic [63:0] subscribe_cmd_vel_linear_x_data,
  input  logic        subscribe_cmd_vel_linear_x_valid,
  output logic        subscribe_cmd_vel_linear_x_ready,
  input  logic [63:0] subscribe_cmd_vel_linear_y_data,
  input  logic        subscribe_cmd_vel_linear_y_valid,
  output logic        subscribe_cmd_vel_linear_y_ready,
  input  logic [63:0] subscribe_cmd_vel_linear_z_data,
  input  logic        subscribe_cmd_vel_linear_z_valid,
  output logic        subscribe_cmd_vel_linear_z_ready,
  input  logic [63:0] subscribe_cmd_vel_angular_x_data,
  input  logic        subscribe_cmd_vel_angular_x_valid,
  output logic        subscribe_cmd_vel_angular_x_ready,
  input  logic [63:0] subscribe_cmd_vel_angular_y_data,
  input  logic        subscribe_cmd_vel_angular_y_valid,
  output logic        subscribe_cmd_vel_angular_y_ready,
  input  logic [63:0] subscribe_cmd_vel_angular_z_data,
  input  logic        subscribe_cmd_vel_angular_z_valid,
  output logic        subscribe_cmd_vel_angular_z_ready,

  output logic [63:0] publish_wheel_left_data_data,
  output logic        publish_wheel_left_data_valid,
  input  logic        publish_wheel_left_data_ready,
  output logic [63:0] publish_wheel_right_data_data,
  output logic        publish_wheel_right_data_valid,
  input  logic        publish_wheel_right_data_ready
);
  // Numbers inside are signed, with 16 of 32 bits after the point.
  localparam int TOP = 1023 + 14;

  // The float64 as a fixed-point number, cut towards 0. What is too large becomes the largest or
  // the smallest number, and NaN becomes 0.
  function automatic logic signed [31:0] to_fixed(logic [63:0] number);
    logic [10:0] exponent;
    logic [52:0] value;
    logic signed [31:0] result;
    exponent = number[62:52];
    value    = {1'b1, number[51:0]};
    // The highest bit goes to bit 30 of the result, and down by what its exponent is below TOP.
    value  = int'(exponent) + 63 < TOP ? 53'd0 : value >> (TOP - int'(exponent));
    result = {1'b0, value[52:22]};
    if (int'(exponent) > TOP) return number[63] ? 32'sh80000000 : 32'sh7fffffff;
    return number[63] ? -result : result;
  endfunction

  function automatic logic is_nan(logic [63:0] number);
    return number[62:52] == 2047 && number[51:0] != 0;
  endfunction

  // The float64 that is equal to a fixed-point number.
  function automatic logic [63:0] to_float(logic signed [32:0] fixed);
    logic [32:0] magnitude;
    logic [10:0] exponent;
    logic [51:0] mantissa;
    magnitude = fixed[32] ? -fixed : fixed;
    exponent  = 0;
    mantissa  = 0;
    // The highest bit that is set decides: it is the last one of the loop.
    for (int place = 0; place <= 32; place++) begin
      if (magnitude[place]) begin
        exponent = 11'(1023 - 16 + place);
        mantissa = {19'd0, magnitude} << (52 - place);
      end
    end
    return {fixed[32], exponent, mantissa};
  endfunction

  // Fields that are not used have to be taken, too.
  assign subscribe_cmd_vel_linear_y_ready  = 1'b1;
  assign subscribe_cmd_vel_linear_z_ready  = 1'b1;
  assign subscribe_cmd_vel_angular_x_ready = 1'b1;
  assign subscribe_cmd_vel_angular_y_ready = 1'b1;

  // Both numbers of a command are taken together, when the speeds of the last one are gone.
  logic left_valid = 1'b0, right_valid = 1'b0, take;
  assign take = subscribe_cmd_vel_linear_x_valid && subscribe_cmd_vel_angular_z_valid
      && (!left_valid || publish_wheel_left_data_ready)
      && (!right_valid || publish_wheel_right_data_ready);
  assign subscribe_cmd_vel_linear_x_ready  = take;
  assign subscribe_cmd_vel_angular_z_ready = take;

  logic signed [32:0] forward, turn, left, right;
  assign forward = is_nan(subscribe_cmd_vel_linear_x_data) ? 0
      : 33'(to_fixed(subscribe_cmd_vel_linear_x_data));
  assign turn = is_nan(subscribe_cmd_vel_angular_z_data) ? 0
      : 33'(to_fixed(subscribe_cmd_vel_angular_z_data));

  always_ff @(posedge aclk) begin
    if (publish_wheel_left_data_ready) left_valid <= 1'b0;
    if (publish_wheel_right_data_ready) right_valid <= 1'b0;
    if (take) begin
      left        <= forward - (turn >>> 2);
      right       <= forward + (turn >>> 2);
      left_valid  <= 1'b1;
      right_valid <= 1'b1;
    end
    if (!aresetn) begin
      left_valid  <= 1'b0;
      right_valid <= 1'b0;
    end
  end

  assign publish_wheel_left_data_data   = to_float(left);
  assign publish_wheel_left_data_valid  = left_valid;
  assign publish_wheel_right_data_data  = to_float(right);
  assign publish_wheel_right_data_valid = right_valid;
endmodule
