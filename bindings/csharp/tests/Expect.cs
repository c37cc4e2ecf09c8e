// What tests say, and the program that runs them: all public static methods of the classes called ...Tests.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using Crumble;

static class Expect {
  public static void True(bool fine, string what = "") { if (!fine) throw new Exception("not true: " + what); }
  public static void Equal<T>(T expected, T got, string what = "") {
    if (!EqualityComparer<T>.Default.Equals(expected, got))
      throw new Exception(what + ": expected " + expected + ", got " + got);
  }
  public static void Near(double expected, double got, double tolerance, string what = "") {
    if (!(Math.Abs(expected - got) <= tolerance)) throw new Exception(what + ": expected " + expected + ", got " + got);
  }
  public static void Same<T>(IEnumerable<T> expected, IEnumerable<T> got, string what = "") {
    True(expected.SequenceEqual(got), what + " differ");
  }
  /// <summary>The library says no, with this code, and its text has all the words.</summary>
  public static CrumbleException Fails(ResultCode code, Action call, params string[] words) {
    try {
      call();
    } catch (CrumbleException error) {
      Equal(code, error.Code, error.Message);
      foreach (string word in words) True(error.Message.Contains(word), error.Message + " lacks " + word);
      return error;
    }
    throw new Exception("expected " + code + ", and nothing was thrown");
  }
  public static void Throws<T>(Action call, params string[] words) where T : Exception {
    try {
      call();
    } catch (T error) {
      foreach (string word in words) True(error.Message.Contains(word), error.Message + " lacks " + word);
      return;
    }
    throw new Exception("expected " + typeof(T).Name + ", and nothing was thrown");
  }
}

static class Runner {
  /// <summary>A folder that tests may write to.</summary>
  public static string Work;

  static int Main(string[] arguments) {
    Work = arguments[0];
    int failed = 0, passed = 0;
    IEnumerable<Type> classes = Assembly.GetExecutingAssembly().GetTypes().Where(t => t.Name.EndsWith("Tests"));
    foreach (Type tests in classes.OrderBy(t => t.Name, StringComparer.Ordinal)) {
      foreach (MethodInfo test in tests.GetMethods(BindingFlags.Public | BindingFlags.Static | BindingFlags.DeclaredOnly)) {
        try {
          test.Invoke(null, null);
          ++passed;
        } catch (TargetInvocationException error) {
          Console.WriteLine("FAILED " + tests.Name + "." + test.Name + "\n" + error.InnerException);
          ++failed;
        }
      }
    }
    Console.WriteLine(passed + " passed, " + failed + " failed");
    return failed == 0 && passed > 0 ? 0 : 1;
  }
}
