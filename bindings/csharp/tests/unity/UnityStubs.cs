// As much of UnityEngine as the sample needs, so that it can be compiled and run here.
using System;
using System.Collections.Generic;

namespace UnityEngine {

public struct Vector3 {
  public float x, y, z;
  public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
  public static Vector3 zero { get { return new Vector3(); } }
  public static Vector3 Cross(Vector3 a, Vector3 b) {
    return new Vector3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  }
  public static float Dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  public static Vector3 operator -(Vector3 a, Vector3 b) { return new Vector3(a.x - b.x, a.y - b.y, a.z - b.z); }
}

public struct Quaternion {
  public float x, y, z, w;
  public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
  public static Quaternion identity { get { return new Quaternion(0, 0, 0, 1); } }
  public static Quaternion Inverse(Quaternion q) { return new Quaternion(-q.x, -q.y, -q.z, q.w); }
  public static Quaternion operator *(Quaternion a, Quaternion b) {
    return new Quaternion(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
  }
}

public class Object { public static void Destroy(Object it) {} }
public class Component : Object {
  readonly Dictionary<Type, object> parts = new Dictionary<Type, object>();
  public Transform transform = null;
  public T GetComponent<T>() where T : new() {
    if (!parts.ContainsKey(typeof(T))) parts[typeof(T)] = new T();
    return (T)parts[typeof(T)];
  }
}
public class MonoBehaviour : Component { public MonoBehaviour() { transform = new Transform(); } }
public class Transform : Component { // not scaled, not turned
  public Vector3 position = Vector3.zero;
  public Quaternion rotation = Quaternion.identity;
  public Vector3 InverseTransformPoint(Vector3 p) { return p - position; }
}
public class MeshFilter : Component { public Mesh sharedMesh; }
public class MeshRenderer : Component {}
public class Mesh : Object {
  public readonly List<Vector3> vertices = new List<Vector3>(), normals = new List<Vector3>();
  public readonly List<int>[] triangles = {new List<int>(), new List<int>()};
  public Rendering.IndexFormat indexFormat;
  public int subMeshCount;
  public void MarkDynamic() {}
  public void Clear() { vertices.Clear(); normals.Clear(); triangles[0].Clear(); triangles[1].Clear(); }
  public void SetVertices(List<Vector3> all) { vertices.AddRange(all); }
  public void SetNormals(List<Vector3> all) { normals.AddRange(all); }
  public void SetTriangles(List<int> all, int subMesh) { triangles[subMesh].AddRange(all); }
}

public static class Time { public static float fixedDeltaTime = 0.02f; }
public static class Mathf {
  public static int Max(int a, int b) { return Math.Max(a, b); }
  public static int RoundToInt(float x) { return (int)Math.Round(x); }
}
[AttributeUsage(AttributeTargets.Class)]
public sealed class RequireComponent : Attribute { public RequireComponent(Type a, Type b) {} }
public sealed class TooltipAttribute : Attribute { public TooltipAttribute(string text) {} }

namespace Rendering { public enum IndexFormat { UInt16, UInt32 } }

}
