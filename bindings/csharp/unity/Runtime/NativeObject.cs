using System;

namespace Crumble {

/// <summary>An object of the library and its end.</summary>
/// <remarks>The handle stays when the object is gone: it is an index into the library's table, which answers every later
/// use with CRUMBLE_E_STALE_HANDLE. So there is nothing to guard here, and no lock in a call.</remarks>
public abstract class NativeObject : IDisposable {
  bool owned;

  internal IntPtr Handle { get; private set; }

  /// <summary>Of an object that may be missing: the library has a word for that.</summary>
  internal static IntPtr HandleOf(NativeObject it) { return it == null ? IntPtr.Zero : it.Handle; }

  internal void Own(IntPtr handle) {
    Handle = handle;
    owned = true;
  }

  /// <summary>The _destroy function.</summary>
  internal abstract int Release();
  /// <summary>After a successful _destroy.</summary>
  internal virtual void Released() {}

  /// <summary>Destroys the object, and says why when that is not possible: CRUMBLE_E_STALE_HANDLE the second time,
  /// CRUMBLE_E_IN_USE while a loop needs it.</summary>
  public void Destroy() {
    Check(Release());
    Forget();
  }

  /// <summary>Destroys the object, at the latest when nothing needs it any more and the garbage collector comes by. May
  /// be called again.</summary>
  public void Dispose() {
    if (owned && Release() == 0) Forget();
  }

  void Forget() {
    if (owned) Released();
    owned = false;
    GC.SuppressFinalize(this);
  }

  // Garbage is collected in no order: what a loop still needs has another turn after it.
  ~NativeObject() {
    if (!owned) return;
    int result = Release();
    if (result == 0) Released();
    else if (Needed(result) && !Environment.HasShutdownStarted) GC.ReRegisterForFinalize(this);
  }

  static bool Needed(int result) {
    return result == (int)ResultCode.InUse || result == (int)ResultCode.Busy;
  }

  /// <summary>Throws what a call answered. The object lives until the call is over.</summary>
  internal void Check(int result) {
    if (result != 0) throw CrumbleException.Last(result);
    GC.KeepAlive(this);
  }
}

}
