namespace Crumble {

/// <summary>Three numbers in a row, as in double[3] of the C API.</summary>
public struct Vec3 {
  public double X, Y, Z;
  public Vec3(double x, double y, double z) { X = x; Y = y; Z = z; }
  public override string ToString() { return "(" + X + ", " + Y + ", " + Z + ")"; }
}

/// <summary>A quaternion in the order of the C API: w, x, y, z.</summary>
public struct Quat {
  public double W, X, Y, Z;
  public Quat(double w, double x, double y, double z) { W = w; X = x; Y = y; Z = z; }
  /// <summary>No turn.</summary>
  public static Quat Identity { get { return new Quat(1, 0, 0, 0); } }
  public override string ToString() { return "(" + W + "; " + X + ", " + Y + ", " + Z + ")"; }
}

public partial struct Pose {
  /// <summary>At a place, m, turned by a unit quaternion.</summary>
  public Pose(Vec3 position, Quat orientation) { Position = position; Orientation = orientation; }
  /// <summary>At a place, m, not turned.</summary>
  public Pose(double x, double y, double z) : this(new Vec3(x, y, z), Quat.Identity) {}
  /// <summary>At the origin, not turned. A pose of zeros is none: its quaternion is not unit.</summary>
  public static Pose Identity { get { return new Pose(0, 0, 0); } }
}

}
