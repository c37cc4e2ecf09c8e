using System.Collections.Generic;
using Crumble;
using UnityEngine;
using Mesh = UnityEngine.Mesh;
using Pose = Crumble.Pose;

/// <summary>The paper's tofu cube, 3 cm wide, standing on y = 0 of this object, under a stick that moves with a transform.
/// Steps of 1 ms in FixedUpdate; what is left of it is drawn in Update.</summary>
[RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
public sealed class TofuBehaviour : MonoBehaviour {
  [Tooltip("Moves the stick: 8 mm thick, 5 cm long along its z axis, in the measure of this object.")]
  public Transform stick;
  [Tooltip("Wall time for the steps of one FixedUpdate, s, 0: as they take. Steps beyond it are dropped.")]
  public float budget = 0.01f;

  /// <summary>What the body does to the stick, N, mean of the last FixedUpdate, in the axes of this object.</summary>
  public Vector3 Force { get; private set; }
  /// <summary>Springs cut so far.</summary>
  public ulong Cuts { get; private set; }
  /// <summary>Steps dropped in the last FixedUpdate, for want of time: the body is late by so many.</summary>
  public uint Dropped { get; private set; }

  Simulation sim;
  Reader reader;
  Mesh mesh;
  double tau;
  // grow when the surface does, and make no garbage else
  double[] points = new double[0];
  uint[] corners = new uint[0];
  float[] cornerNormals = new float[0];
  readonly List<Vector3> vertices = new List<Vector3>(), normals = new List<Vector3>();
  readonly List<int> skin = new List<int>(), inside = new List<int>();

  void OnEnable() {
    using (Crumble.Mesh cube = Crumble.Mesh.CreatePaper(PaperBody.Cube)) sim = new Simulation(cube);
    sim.FixBelow(1e-6);
    sim.AddTool(new ToolDef());
    tau = sim.GetDef().Tau;
    reader = new Reader(sim);
    mesh = new Mesh();
    mesh.indexFormat = UnityEngine.Rendering.IndexFormat.UInt32;
    mesh.MarkDynamic();
    GetComponent<MeshFilter>().sharedMesh = mesh;
    Wrench nothing;
    sim.TryStep(StickPose(), out nothing); // where the stick begins
  }

  void OnDisable() {
    reader.Dispose();
    sim.Dispose();
    Destroy(mesh);
  }

  void FixedUpdate() {
    int steps = Mathf.Max(1, Mathf.RoundToInt((float)(Time.fixedDeltaTime / tau)));
    Wrench mean;
    AdvanceInfo info;
    if (sim.TryAdvance(StickPose(), out mean, out info, (uint)steps, budget) == ResultCode.Diverged) sim.Reset();
    Force = ToUnity(mean.Force);
    Dropped = info.Dropped;
  }

  void Update() {
    sim.Publish(); // one thread: hand the state over
    ReaderInfo info = reader.Update();
    Cuts = info.Cuts;
    Reserve(ref points, 3 * info.VertexCount);
    Reserve(ref corners, 3 * info.TriangleCount);
    Reserve(ref cornerNormals, 9 * info.TriangleCount);
    reader.CopySurfacePositions(points);
    reader.CopySurfaceTriangles(corners);
    reader.CopySurfaceNormals(cornerNormals);
    FillLists((int)info.TriangleCount, (int)info.SkinTriangleCount);
    mesh.Clear();
    mesh.SetVertices(vertices);
    mesh.SetNormals(normals);
    mesh.subMeshCount = 2;
    mesh.SetTriangles(skin, 0);
    mesh.SetTriangles(inside, 1);
  }

  // Each corner has a normal of its own, so each becomes a vertex. Seen in a mirror, corners go round the other way.
  void FillLists(int triangles, int skinTriangles) {
    vertices.Clear();
    normals.Clear();
    skin.Clear();
    inside.Clear();
    for (int corner = 0; corner < 3 * triangles; ++corner) {
      uint point = 3 * corners[corner];
      vertices.Add(new Vector3((float)points[point], (float)points[point + 1], -(float)points[point + 2]));
      normals.Add(new Vector3(cornerNormals[3 * corner], cornerNormals[3 * corner + 1], -cornerNormals[3 * corner + 2]));
    }
    for (int triangle = 0; triangle < triangles; ++triangle) {
      List<int> list = triangle < skinTriangles ? skin : inside;
      list.Add(3 * triangle);
      list.Add(3 * triangle + 2);
      list.Add(3 * triangle + 1);
    }
  }

  // The stick in the axes of this object.
  Pose StickPose() {
    return ToCrumble(transform.InverseTransformPoint(stick.position),
                     Quaternion.Inverse(transform.rotation) * stick.rotation);
  }

  // Unity is left-handed: z is turned round, and with it what turns about x and y.
  static Pose ToCrumble(Vector3 p, Quaternion q) {
    return new Pose(new Vec3(p.x, p.y, -p.z), new Quat(q.w, -q.x, -q.y, q.z));
  }
  static Vector3 ToUnity(Vec3 v) { return new Vector3((float)v.X, (float)v.Y, -(float)v.Z); }

  static void Reserve<T>(ref T[] array, uint length) {
    if (array.Length < length) array = new T[length + length / 2];
  }
}
