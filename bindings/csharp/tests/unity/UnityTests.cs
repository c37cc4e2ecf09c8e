// Runs the sample of the Unity package against the doubles.
using System.Linq;
using System.Reflection;
using UnityEngine;

static class UnityTests {
  static void Send(TofuBehaviour tofu, string message) {
    typeof(TofuBehaviour).GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(tofu, null);
  }

  public static void TheSampleBreaksAndDrawsTofu() {
    var tofu = new TofuBehaviour {stick = new Transform(), budget = 0};
    tofu.transform.position = new Vector3(1, 2, 3);
    tofu.stick.position = new Vector3(1, 2.034f, 3);
    Send(tofu, "OnEnable");
    Send(tofu, "Update");
    UnityEngine.Mesh drawn = tofu.GetComponent<MeshFilter>().sharedMesh;
    int whole = drawn.vertices.Count;
    Expect.Equal(0, drawn.triangles[1].Count, "nothing is open yet");
    for (int frame = 1; frame <= 75; ++frame) { // 10 mm/s for 1.5 s
      tofu.stick.position.y = 2.034f - 0.0002f * frame;
      Send(tofu, "FixedUpdate");
    }
    Send(tofu, "Update");
    Expect.True(tofu.Force.y > 0.3f && tofu.Cuts > 50, tofu.Force.y + " N, " + tofu.Cuts + " cuts");
    Expect.Equal(0u, tofu.Dropped);
    Expect.True(drawn.vertices.Count > whole && drawn.triangles[1].Count > 0, "cracks are drawn");
    Expect.Equal(drawn.vertices.Count, drawn.triangles[0].Count + drawn.triangles[1].Count);
    Expect.Equal(drawn.vertices.Count, drawn.normals.Count);
    Expect.True(drawn.vertices.All(v => System.Math.Abs(v.x) < 0.05 && v.y < 0.04), "in place");
    FacesOutward(drawn);
    tofu.budget = 1e-9f;
    Send(tofu, "FixedUpdate");
    Expect.Equal(19u, tofu.Dropped, "of 20");
    Send(tofu, "OnDisable");
  }

  // Unity shows the side from which corners go round clockwise: left-handed cross products point to it, as normals do.
  static void FacesOutward(UnityEngine.Mesh drawn) {
    int same = 0, all = 0;
    double volume = 0;
    foreach (int[] triangle in drawn.triangles.SelectMany(list => Enumerable.Range(0, list.Count / 3).Select(
                 i => new[] {list[3 * i], list[3 * i + 1], list[3 * i + 2]}))) {
      Vector3 a = drawn.vertices[triangle[0]], b = drawn.vertices[triangle[1]], c = drawn.vertices[triangle[2]];
      Vector3 normal = Vector3.Cross(b - a, c - a);
      same += Vector3.Dot(normal, drawn.normals[triangle[0]]) > 0 ? 1 : 0;
      volume += Vector3.Dot(a, Vector3.Cross(b, c)) / 6;
      ++all;
    }
    Expect.True(same > 0.95 * all, same + " of " + all);
    Expect.Near(2.6e-5, volume, 0.4e-5, "volume");
  }

  // The stick turned about y in Unity is turned the other way round in right-handed axes.
  public static void TurnsGoTheOtherWayRound() {
    MethodInfo convert = typeof(TofuBehaviour).GetMethod("ToCrumble", BindingFlags.Static | BindingFlags.NonPublic);
    var pose = (Crumble.Pose)convert.Invoke(null, new object[] {new Vector3(1, 2, 3), new Quaternion(0.1f, 0.6f, 0.2f, 0.7f)});
    Expect.Equal(-3.0, pose.Position.Z);
    Expect.Near(-0.6, pose.Orientation.Y, 1e-6);
    Expect.Near(0.2, pose.Orientation.Z, 1e-6);
  }
}
