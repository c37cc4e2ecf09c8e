using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Crumble {

/// <summary>UTF-8 of the library, which ends with a zero.</summary>
static unsafe class Text {
  public static string From(byte* text) {
    if (text == null) return null;
    int length = 0;
    while (text[length] != 0) ++length;
    return length == 0 ? "" : Encoding.UTF8.GetString(text, length);
  }

  /// <summary>Null stays null: the library has a word for it.</summary>
  public static byte[] Bytes(string text) {
    return text == null ? null : Encoding.UTF8.GetBytes(text + "\0");
  }
}

/// <summary>Keeps arrays and strings of a definition in their places during one call.</summary>
sealed class Pins : IDisposable {
  readonly List<GCHandle> handles = new List<GCHandle>();

  public IntPtr Array(Array array) {
    if (array == null) return IntPtr.Zero;
    GCHandle handle = GCHandle.Alloc(array, GCHandleType.Pinned);
    handles.Add(handle);
    return handle.AddrOfPinnedObject();
  }

  public IntPtr Text(string text) { return Array(Crumble.Text.Bytes(text)); }

  /// <summary>Rows of an array with so many scalars in each.</summary>
  public static uint Rows(Array array, int columns, string name) {
    if (array == null) return 0;
    if (array.Length % columns != 0)
      throw new ArgumentException(name + ": " + array.Length + " numbers make no rows of " + columns);
    return (uint)(array.Length / columns);
  }

  public void Dispose() {
    foreach (GCHandle handle in handles) handle.Free();
    handles.Clear();
  }
}

}
