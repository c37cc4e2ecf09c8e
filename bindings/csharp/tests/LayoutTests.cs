// What this compiler and runtime make of the generated structs, against what the C compiler made of them.
using System;
using System.Collections.Generic;
using System.Reflection;
using System.Runtime.InteropServices;
using Crumble;

class Layout {
  public int Structs, Fields;
  public void Size(string name, int got, int expected) {
    Expect.Equal(expected, got, "size of " + name);
    ++Structs;
  }
  public void Offset(string name, long got, int expected) {
    Expect.Equal(expected, (int)got, "offset of " + name);
    ++Fields;
  }
}

static class LayoutTests {
  public static void SizesAndOffsetsAreThoseOfC() {
    var layout = new Layout();
    LayoutTable.Check(layout);
    Expect.True(layout.Structs >= 32 && layout.Fields > 300, "structs are missing");
  }

  // Pinning works for these alone, and so does passing them without a copy.
  public static void AllStructsAreBlittable() {
    int seen = 0;
    foreach (Type type in typeof(Native).Assembly.GetTypes()) {
      if (!type.IsValueType || type.IsEnum || !type.IsPublic && !type.IsNestedPublic) continue;
      GCHandle.Alloc(Activator.CreateInstance(type), GCHandleType.Pinned).Free();
      ++seen;
    }
    Expect.True(seen > 30);
  }

  public static void EveryFunctionIsThere() {
    Library.KernelName(0);
    Type imports = typeof(Native).GetNestedType("Imports", BindingFlags.NonPublic);
    var missing = new List<string>();
    int seen = 0;
    foreach (MethodInfo import in imports.GetMethods(BindingFlags.Public | BindingFlags.Static | BindingFlags.DeclaredOnly)) {
      try {
        Marshal.Prelink(import);
        ++seen;
      } catch (EntryPointNotFoundException) { missing.Add(import.Name); }
    }
    Expect.Equal("", string.Join(" ", missing), "missing in the library");
    Expect.True(seen >= 100);
  }
}
